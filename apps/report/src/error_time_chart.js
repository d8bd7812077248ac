// Error against time on logarithmic axes: a line per method over the Pareto front with its names.
import * as Plot from '@observablehq/plot';
import { cellName, errorAxis, errors, frontOf, seriesOf, shownPoints } from './cells.js';
import { logAxis, margin, nothing, plot, tip } from './chart.js';
import { figure, withUnit } from './format.js';
import { placeLabels } from './place_labels.js';

const xy = { x: 'ms', y: 'error' };

const dashOf = (temporal) => (temporal ? null : '5 4');

function tipText(work, point, choice) {
    const { cell, time } = point;
    return [
        cellName(work, cell),
        `${errors[choice.error].title} ${figure(point.error)}`,
        `${withUnit(time.median, 'ms')} (${figure(time.min)} to ${figure(time.max)})`,
        `converged: RMSE ${figure(cell.converged?.rmse_influenced)}, FLIP ${figure(cell.converged?.flip)}`,
        `truth: RMSE ${figure(cell.truth?.rmse_influenced)}, FLIP ${figure(cell.truth?.flip)}`,
    ].join('\n');
}

function seriesMarks(work, { method, temporal, points }) {
    const look = work.lookOf(method);
    return [
        Plot.ruleY(points, {
            x1: (p) => p.time.min,
            x2: (p) => p.time.max,
            y: 'error',
            stroke: look.colour,
            strokeOpacity: 0.5,
        }),
        Plot.line(points, {
            ...xy,
            stroke: look.colour,
            strokeWidth: look.strokeWidth,
            strokeDasharray: dashOf(temporal),
        }),
        Plot.dot(points, {
            ...xy,
            r: 4,
            symbol: look.symbol,
            stroke: look.colour,
            strokeWidth: 1.5,
            fill: temporal ? look.colour : 'var(--surface)',
        }),
    ];
}

function frontMarks(work, front) {
    return [
        Plot.line(front, {
            ...xy,
            curve: 'step-after', // until the next point is affordable, this one is the best
            stroke: 'var(--front)',
            strokeWidth: 8,
            strokeLinejoin: 'round',
            strokeLinecap: 'round',
        }),
        Plot.dot(front, { ...xy, r: 8, fill: 'var(--front)' }),
        Plot.dot(
            front.filter((point) => point.cell.knob !== 'samples'),
            { ...xy, r: 3, fill: (point) => work.lookOf(point.cell.method).colour },
        ),
    ];
}

function axes(drawn, choice, width) {
    const times = drawn.flatMap(({ time }) => [time.min, time.max]).filter((ms) => ms > 0);
    const clock = choice.clock === 'wall' ? 'wall clock' : 'all cores together';
    const roomForNames = width > 600 ? 2 : 1.4;
    const values = drawn.map((point) => point.error);
    return {
        x: logAxis(times, `time per frame (ms, ${clock})`, { low: roomForNames, most: width / 60 }),
        y: logAxis(values, errorAxis(choice), { low: 1.4, most: 12 }),
    };
}

function nameMarks(work, front, { x, y }, { width, height }) {
    const named = front.map((point, i) => {
        return { ...point, number: String(i + 1), text: cellName(work, point.cell) };
    });
    const area = {
        width: width - margin.left - margin.right,
        height: height - margin.top - margin.bottom,
    };
    return Plot.text(placeLabels(named, x.domain, y.domain, area), {
        ...xy,
        text: 'text',
        textAnchor: 'end',
        dx: -9,
        dy: 10,
        fontSize: 11,
        fill: 'var(--ink)',
        stroke: 'var(--surface)',
        strokeWidth: 4,
    });
}

/** The chart of what `choice` shows but for the `hidden` methods, `width` px wide. */
export function drawErrorTime(work, choice, hidden, width) {
    const points = shownPoints(work, choice).filter((point) => !hidden.has(point.cell.method));
    const series = seriesOf(work, points);
    if (series.length === 0) return nothing('No cell that is shown has this error.');
    const front = frontOf(work, points, choice);
    const drawn = [...new Set([...series.flatMap((each) => each.points), ...front])];
    const size = { width, height: Math.round(Math.min(560, Math.max(340, width * 0.58))) };
    const { x, y } = axes(drawn, choice, width);
    const title = (point) => tipText(work, point, choice);
    return plot({
        ...size,
        x,
        y,
        marks: [
            ...frontMarks(work, front),
            ...series.flatMap((each) => seriesMarks(work, each)),
            nameMarks(work, front, { x, y }, size),
            tip(drawn, { ...xy, title }),
        ],
    });
}
