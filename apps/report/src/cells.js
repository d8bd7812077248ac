// Cells of a work: their errors, times and names, which are shown, and the front among them.
import { isFigure } from './format.js';
import { plainLook } from './palette.js';

export const errors = {
    rmse: {
        title: 'RMSE',
        axis: 'RMSE of influenced pixels (relative radiance)',
        key: 'rmse_influenced',
        unit: 'relative radiance',
    },
    flip: { title: 'FLIP', axis: 'FLIP (0 to 1)', key: 'flip', unit: '0 to 1' },
};

export const references = {
    converged: 'the converged image of the same geometry',
    truth: 'the truth',
};

export const firstChoice = {
    error: 'rmse',
    reference: 'converged',
    temporal: 'both',
    clock: 'wall',
};

export const errorOf = (cell, choice) => cell[choice.reference]?.[errors[choice.error].key] ?? null;
export const timeOf = (cell, choice) => cell[`${choice.clock}_ms`]?.total ?? null;

export const errorAxis = (choice) =>
    `${errors[choice.error].axis}, against ${choice.reference === 'truth' ? 'truth' : 'converged'}`;

/** `Axis-aligned filter · 16 spp · previous frame · split 8x2`. */
export function cellName(work, cell) {
    const parts = [work.methods.get(cell.method)?.title ?? cell.method];
    if (isFigure(cell.samples)) parts.push(`${cell.samples} spp`);
    if (cell.temporal) parts.push('previous frame');
    if (cell.knob !== 'samples') parts.push(`${cell.knob} ${cell.value}`);
    return parts.join(' · ');
}

/** Whether a cell is shown; `with` keeps the methods that have no use of the previous frame. */
function isChosen(work, cell, choice) {
    if (choice.temporal === 'both') return true;
    if (choice.temporal === 'without') return !cell.temporal;
    return cell.temporal || !work.temporalMethods.has(cell.method);
}

/** The cells that the choice shows, with a positive error and time, cheapest first: `{cell, error, ms}`. */
export function shownPoints(work, choice) {
    return work.cells
        .filter((cell) => !cell.failed && isChosen(work, cell, choice))
        .map((cell) => ({ cell, error: errorOf(cell, choice), time: timeOf(cell, choice) }))
        .filter(
            ({ error, time }) =>
                isFigure(error) && error > 0 && isFigure(time?.median) && time.median > 0,
        )
        .map((point) => ({ ...point, ms: point.time.median }))
        .sort((a, b) => a.ms - b.ms);
}

/** Points that no other point beats in both time and error, cheapest first. */
export function paretoFront(points) {
    const front = [];
    for (const point of [...points].sort((a, b) => a.ms - b.ms || a.error - b.error)) {
        if (front.length === 0 || point.error < front.at(-1).error) front.push(point);
    }
    return front;
}

/** The front that the data states, where the choice is the one it was stated for; else that of the points shown. */
export function frontOf(work, points, choice) {
    const ids = work.fronts?.[choice.error];
    if (
        !ids ||
        choice.reference !== 'converged' ||
        choice.temporal !== 'both' ||
        choice.clock !== 'wall'
    ) {
        return paretoFront(points);
    }
    const byId = new Map(points.map((point) => [point.cell.id, point]));
    return ids.map((id) => byId.get(id)).filter(Boolean);
}

/** Points of the `samples` rows as series: one per method and use of the previous frame, few samples first. */
export function seriesOf(work, points) {
    const series = new Map();
    for (const point of points) {
        if (point.cell.knob !== 'samples') continue;
        const key = `${point.cell.method}/${point.cell.temporal}`;
        if (!series.has(key))
            series.set(key, {
                method: point.cell.method,
                temporal: point.cell.temporal,
                points: [],
            });
        series.get(key).points.push(point);
    }
    for (const each of series.values()) each.points.sort((a, b) => a.cell.samples - b.cell.samples);
    return [...series.values()];
}

/** A work of the report with what the sections look up: methods and their looks, cells by id. */
export function indexWork(report, work, looks) {
    const cells = work.cells ?? [];
    return {
        ...work,
        cells,
        methods: new Map((report.methods ?? []).map((method) => [method.name, method])),
        lookOf: (method) => looks.get(method) ?? plainLook,
        byId: new Map(cells.map((cell) => [cell.id, cell])),
        temporalMethods: new Set(cells.filter((cell) => cell.temporal).map((cell) => cell.method)),
    };
}
