// What each frame's errors were allowed to be, beside what they are.
import * as Plot from '@observablehq/plot';
import { chart, frameAxis, plot, swatches, tip } from './chart.js';
import { choices, segments } from './choices.js';
import { h, section } from './dom.js';
import { figure, isFigure, percent, tick } from './format.js';
import { seriesColour } from './palette.js';
import { table } from './tables.js';

const axes = {
    RMSE: 'RMSE of influenced pixels, against truth (relative radiance)',
    E_R: 'relative RMSE of E_R, light without the objects',
    E_RV: 'relative RMSE of E_RV, light with the objects',
    flicker: 'RMS change of a still camera’s picture (relative radiance)',
};
const names = { value: 'measured', allowed: 'allowed' };
const colours = { value: seriesColour(0), allowed: seriesColour(1) };

const of = (row, name) => row.figures?.find((each) => each.figure === name);

function draw(rows, name, width) {
    const points = rows
        .flatMap((row) =>
            Object.keys(names).map((kind) => ({
                frame: row.frame,
                kind,
                value: of(row, name)?.[kind],
            })),
        )
        .filter((each) => isFigure(each.value));
    return plot({
        width,
        height: 240,
        x: frameAxis(
            points.map((each) => each.frame),
            width,
        ),
        y: {
            label: axes[name],
            labelArrow: 'none',
            grid: true,
            zero: true,
            nice: true,
            tickFormat: tick,
            ticks: 5,
        },
        marks: [
            ...Object.keys(names).map((kind) =>
                Plot.line(
                    points.filter((each) => each.kind === kind),
                    {
                        x: 'frame',
                        y: 'value',
                        stroke: colours[kind],
                        strokeWidth: 2,
                        strokeDasharray: kind === 'allowed' ? '5 4' : null,
                    },
                ),
            ),
            Plot.dot(points, {
                x: 'frame',
                y: 'value',
                r: points.length > 200 ? 1.5 : 3,
                fill: (each) => colours[each.kind],
            }),
            tip(points, {
                x: 'frame',
                y: 'value',
                title: (each) => `${names[each.kind]}\nframe ${each.frame}: ${figure(each.value)}`,
            }),
        ],
    });
}

const pair = (name) => ({
    title: name,
    unit: 'of allowed',
    value: (row) => {
        const found = of(row, name);
        return found ? `${figure(found.value)} of ${figure(found.allowed)}` : figure(null);
    },
});
const part = (title, key, unit) => ({ title, unit, value: (row) => figure(row.parts?.[key]) });

export function budgetSection(work) {
    const rows = work.budget ?? [];
    if (rows.length === 0) return null;
    const over = rows.filter((row) => !row.kept);
    const store = choices({ budgeted: 'RMSE' });
    const series = chart('Error and its budget over the frames', (width) =>
        draw(rows, store.get().budgeted, width),
    );
    store.watch(series.redraw);
    return section(
        'budget',
        'Errors and their budgets',
        'What is allowed is derived before the frame is composited: what the reference mode reaches in the ' +
            'true room, and what samples, sensor and poses add. ' +
            (over.length === 0
                ? 'Every frame keeps it.'
                : `Over it: ${over.map((row) => `frame ${row.frame}`).join(', ')}.`),
        h(
            'div',
            { class: 'controls' },
            segments(
                store,
                'budgeted',
                'Error',
                Object.keys(axes).map((name) => [name, name]),
            ),
        ),
        swatches(Object.keys(names).map((kind) => [names[kind], colours[kind]])),
        series.element,
        h(
            'details',
            {},
            h('summary', {}, 'The figures'),
            table(
                'Errors, what was allowed, and the parts of what was allowed',
                [
                    { title: 'Frame', text: true, value: (row) => String(row.frame) },
                    { title: 'Kept', text: true, value: (row) => (row.kept ? 'yes' : 'no') },
                    ...Object.keys(axes).map(pair),
                    part('Equation', 'equation', 'relative radiance'),
                    part('Room as seen', 'room_as_seen', 'relative radiance'),
                    part('Samples and filter', 'sampling', 'relative radiance'),
                    part('Pose and depth', 'displacement', 'relative radiance'),
                    part('Displaced by', 'displaced_px', 'px'),
                    { title: 'Lit', value: (row) => percent(row.compared) },
                ],
                rows,
            ),
        ),
    );
}
