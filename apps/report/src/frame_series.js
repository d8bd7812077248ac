// Error and time of chosen cells over the frames.
import * as Plot from '@observablehq/plot';
import { cellName } from './cells.js';
import { chart, frameAxis, nothing, plot, tip } from './chart.js';
import { choices, segments } from './choices.js';
import { h, section } from './dom.js';
import { figure, isFigure, tick } from './format.js';
import { seriesColour } from './palette.js';

const figures = {
    rmse_influenced: 'RMSE of influenced pixels, against converged (relative radiance)',
    truth_rmse_influenced: 'RMSE of influenced pixels, against truth (relative radiance)',
    flip: 'FLIP, against converged (0 to 1)',
    psnr: 'PSNR, against converged (dB)',
};
const most = 7;

/** Ids to begin with: the filtered anchors, and the unfiltered cell with as many samples as the first. */
function firstIds(work, cells) {
    const anchor = work.byId.get(work.equal_error?.[0]?.anchor) ?? cells[0];
    const plainCell = cells.find(
        (cell) =>
            work.methods.get(cell.method)?.family === 'none' &&
            cell.samples === anchor.samples &&
            cell.knob === 'samples',
    );
    const other = cells.find(
        (cell) =>
            cell.method === anchor.method &&
            cell.samples === anchor.samples &&
            cell.knob === 'samples' &&
            cell.temporal !== anchor.temporal,
    );
    return [
        ...new Set(
            [anchor, other, plainCell]
                .filter((cell) => cells.includes(cell))
                .map((cell) => cell.id),
        ),
    ];
}

function draw(work, chosen, key, label, width) {
    const series = [...chosen].map(([id, colour]) => ({
        colour,
        name: cellName(work, work.byId.get(id)),
        points: work.byId.get(id).frames.filter((each) => isFigure(each[key])),
    }));
    const points = series.flatMap(({ points: list, name, colour }) =>
        list.map((each) => ({ ...each, name, colour })),
    );
    if (points.length === 0) return nothing('None of the chosen cells has this figure.');
    return plot({
        width,
        height: 240,
        x: frameAxis(
            points.map((each) => each.frame),
            width,
        ),
        y: {
            label,
            labelArrow: 'none',
            grid: true,
            zero: key !== 'psnr',
            nice: true,
            tickFormat: tick,
            ticks: 5,
        },
        marks: [
            ...series.map((each) =>
                Plot.line(each.points, { x: 'frame', y: key, stroke: each.colour, strokeWidth: 2 }),
            ),
            Plot.dot(points, {
                x: 'frame',
                y: key,
                r: points.length > 200 ? 1.5 : 3,
                fill: 'colour',
            }),
            tip(points, {
                x: 'frame',
                y: key,
                title: (each) => `${each.name}\nframe ${each.frame}: ${figure(each[key])}`,
            }),
        ],
    });
}

/** The chosen cells with their colours, and controls to add and remove them. */
function cellChooser(work, cells, chosen, onchange) {
    const chips = h('ul', { class: 'chips' });
    const free = () =>
        [...Array(most).keys()]
            .map(seriesColour)
            .find((colour) => ![...chosen.values()].includes(colour));
    const select = h('select', { 'aria-label': 'Add a cell' });
    const update = () => {
        chips.replaceChildren(
            ...[...chosen].map(([id, colour]) =>
                h(
                    'li',
                    {},
                    h('span', { class: 'swatch', style: `background: ${colour}` }),
                    cellName(work, work.byId.get(id)),
                    h(
                        'button',
                        {
                            type: 'button',
                            'aria-label': `Remove ${cellName(work, work.byId.get(id))}`,
                            onclick: () => {
                                chosen.delete(id);
                                update();
                            },
                        },
                        '×',
                    ),
                ),
            ),
        );
        select.replaceChildren(
            h(
                'option',
                { value: '' },
                chosen.size < most ? 'Add a cell …' : `${most} cells at most`,
            ),
            ...cells
                .filter((cell) => !chosen.has(cell.id))
                .map((cell) => h('option', { value: cell.id }, cellName(work, cell))),
        );
        select.disabled = chosen.size >= most;
        onchange();
    };
    select.addEventListener('change', () => {
        if (select.value) chosen.set(select.value, free());
        update();
    });
    return { element: h('div', { class: 'chooser' }, chips, select), update };
}

export function frameSection(work) {
    const cells = work.cells.filter((cell) => !cell.failed && cell.frames?.length > 0);
    if (cells.length === 0) return null;
    const chosen = new Map(firstIds(work, cells).map((id, index) => [id, seriesColour(index)]));
    const store = choices({ figure: 'rmse_influenced' });
    const error = chart('Error of the chosen cells over the frames', (width) =>
        draw(work, chosen, store.get().figure, figures[store.get().figure], width),
    );
    const time = chart('Time of the chosen cells over the frames', (width) =>
        draw(work, chosen, 'ms', 'time per frame (ms)', width),
    );
    const redraw = () => [error, time].forEach((each) => each.redraw());
    store.watch(redraw);
    const chooser = cellChooser(work, cells, chosen, redraw);
    chooser.update();
    return section(
        'frames',
        'Frame by frame',
        'Error and time of the chosen cells in each frame that was measured.',
        h(
            'div',
            { class: 'controls' },
            segments(store, 'figure', 'Error', [
                ['rmse_influenced', 'RMSE'],
                ['truth_rmse_influenced', 'RMSE to truth'],
                ['flip', 'FLIP'],
                ['psnr', 'PSNR'],
            ]),
        ),
        chooser.element,
        error.element,
        time.element,
    );
}
