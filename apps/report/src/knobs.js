// What each knob but the number of samples costs, and what it brings.
import { errorOf, errors, firstChoice, references, timeOf } from './cells.js';
import { choices, segments } from './choices.js';
import { h, section } from './dom.js';
import { figure, isFigure } from './format.js';
import { bar, table } from './tables.js';

const subject = (work, cell) =>
    [
        work.methods.get(cell.method)?.title ?? cell.method,
        isFigure(cell.samples) && `${cell.samples} spp`,
        cell.temporal && 'previous frame',
    ]
        .filter(Boolean)
        .join(' · ');

/** One table: the values of a knob for one method. */
function knobTable(work, knob, cells, choice) {
    const largest = (figureOf) => Math.max(...cells.map((cell) => figureOf(cell) ?? 0));
    const error = (cell) => errorOf(cell, choice),
        ms = (cell) => timeOf(cell, choice)?.median ?? null;
    const failed = (cell) => (cell.failed ? 'failed' : null);
    return table(
        subject(work, cells[0]),
        [
            { title: knob.replaceAll('_', ' '), text: true, value: (cell) => cell.value },
            {
                title: errors[choice.error].title,
                unit: errors[choice.error].unit,
                value: (cell) =>
                    failed(cell) ?? bar(figure(error(cell)), error(cell) / largest(error)),
            },
            {
                title: 'Time',
                unit: 'ms',
                value: (cell) =>
                    failed(cell) ?? bar(figure(ms(cell)), ms(cell) / largest(ms), 'var(--time)'),
            },
        ],
        cells,
        { dense: true },
    );
}

function groups(cells, keyOf) {
    const result = new Map();
    for (const cell of cells) {
        const key = keyOf(cell);
        if (!result.has(key)) result.set(key, []);
        result.get(key).push(cell);
    }
    return result;
}

/** Cells of one table share all but the knob; where the knob changes the samples they may differ. */
function tableKey(cells) {
    const perValue = groups(cells, (cell) => `${cell.method}/${cell.temporal}/${cell.value}`);
    const repeated = [...perValue.values()].some((group) => group.length > 1);
    return (cell) => `${cell.method}/${cell.temporal}${repeated ? `/${cell.samples}` : ''}`;
}

export function knobsSection(work) {
    const knobs = groups(
        work.cells.filter((cell) => cell.knob !== 'samples'),
        (cell) => cell.knob,
    );
    if (knobs.size === 0) return null;
    const store = choices(firstChoice);
    const grid = h('div', { class: 'grid' });
    const update = () =>
        grid.replaceChildren(
            ...[...knobs].map(([knob, cells]) =>
                h(
                    'div',
                    { class: 'knob' },
                    h('h3', {}, knob.replaceAll('_', ' ')),
                    ...[...groups(cells, tableKey(cells)).values()].map((each) =>
                        knobTable(work, knob, each, store.get()),
                    ),
                ),
            ),
        );
    store.watch(update);
    update();
    return section(
        'knobs',
        'Knobs',
        `One setting is changed at a time; shorter bars are better. The error is against ${references.converged} or ${references.truth}.`,
        h(
            'div',
            { class: 'controls' },
            segments(store, 'error', 'Error', [
                ['rmse', 'RMSE'],
                ['flip', 'FLIP'],
            ]),
            segments(store, 'reference', 'Against', [
                ['converged', 'converged'],
                ['truth', 'truth'],
            ]),
        ),
        grid,
    );
}
