// The section of error against time: what is shown, the legend, the chart, and the front by name.
import * as Plot from '@observablehq/plot';
import {
    cellName,
    errorOf,
    errors,
    firstChoice,
    frontOf,
    references,
    shownPoints,
} from './cells.js';
import { chart, plot } from './chart.js';
import { choices, segments } from './choices.js';
import { h, section } from './dom.js';
import { drawErrorTime } from './error_time_chart.js';
import { figure } from './format.js';
import { table } from './tables.js';

function swatch(look) {
    return plot({
        width: 26,
        height: 14,
        marginTop: 0,
        marginLeft: 0,
        marginRight: 0,
        marginBottom: 0,
        x: { domain: [-1, 1], axis: null },
        y: { domain: [-1, 1], axis: null },
        marks: [
            Plot.ruleY([0], { stroke: look.colour, strokeWidth: look.strokeWidth }),
            Plot.dot([[0, 0]], {
                r: 4,
                symbol: look.symbol,
                fill: look.colour,
                stroke: look.colour,
            }),
        ],
    });
}

function legend(work, hidden, onchange) {
    const names = [
        ...new Set(work.cells.filter((cell) => cell.knob === 'samples').map((cell) => cell.method)),
    ];
    return h(
        'div',
        { class: 'legend', role: 'group', 'aria-label': 'Methods; press to hide or show' },
        ...names.map((name) => {
            const method = work.methods.get(name);
            const button = h(
                'button',
                { type: 'button', 'aria-pressed': 'true', title: method?.summary },
                swatch(work.lookOf(name)),
                method?.title ?? name,
            );
            button.addEventListener('click', () => {
                if (!hidden.delete(name)) hidden.add(name);
                button.setAttribute('aria-pressed', String(!hidden.has(name)));
                onchange();
            });
            return button;
        }),
    );
}

function frontTable(work, choice, hidden, wasOpen) {
    const points = shownPoints(work, choice).filter((point) => !hidden.has(point.cell.method));
    const front = frontOf(work, points, choice);
    const settings = front.length === 1 ? '1 setting' : `${front.length} settings`;
    return h(
        'details',
        { open: wasOpen },
        h('summary', {}, `The front by name: ${settings}, cheapest first`),
        table(
            'Nothing shown is both faster and closer.',
            [
                { title: 'No.', text: true, value: (point) => String(front.indexOf(point) + 1) },
                { title: 'Setting', text: true, value: (point) => cellName(work, point.cell) },
                { title: 'Time', unit: 'ms', value: (point) => figure(point.ms) },
                {
                    title: errors[choice.error].title,
                    unit: errors[choice.error].unit,
                    value: (point) => figure(point.error),
                },
            ],
            front,
            { dense: true },
        ),
    );
}

const bothReferences = ['converged', 'truth'].map((name) => [name, name]);

function controls(store, hasTruth) {
    return h(
        'div',
        { class: 'controls' },
        segments(store, 'error', 'Error', [
            ['rmse', 'RMSE'],
            ['flip', 'FLIP'],
        ]),
        segments(store, 'reference', 'Against', hasTruth ? bothReferences : [bothReferences[0]]),
        segments(store, 'temporal', 'Previous frame', [
            ['both', 'either'],
            ['with', 'used'],
            ['without', 'not used'],
        ]),
        segments(store, 'clock', 'Time', [
            ['wall', 'wall'],
            ['cpu', 'CPU'],
        ]),
    );
}

const explanation = (hasTruth) =>
    `Each mark is a number of samples per pixel (spp); lower is closer to ${references.converged}` +
    `${hasTruth ? ` or to ${references.truth}` : ''}, left is faster. Filled marks and full lines ` +
    'use the previous frame, hollow marks and dashed lines do not. The broad band is the Pareto ' +
    'front; where a name has no room its number stands, as in the list below.';

export function errorTimeSection(work) {
    const store = choices(firstChoice);
    const hidden = new Set();
    const picture = chart(
        'Error against time per frame, one line per method, with the Pareto front',
        (width) => drawErrorTime(work, store.get(), hidden, width),
    );
    const front = h('div', { class: 'front-table' });
    const update = () => {
        picture.redraw();
        front.replaceChildren(frontTable(work, store.get(), hidden, front.firstChild?.open));
    };
    store.watch(update);
    update();
    const truth = { ...firstChoice, reference: 'truth' };
    const hasTruth = work.cells.some((cell) => errorOf(cell, truth) !== null);
    return section(
        'error-time',
        'Error against time',
        explanation(hasTruth),
        controls(store, hasTruth),
        legend(work, hidden, update),
        picture.element,
        front,
    );
}
