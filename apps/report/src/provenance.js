// Where the figures come from: machine, date, settings, every cell, and what failed.
import { cellName } from './cells.js';
import { h, section } from './dom.js';
import { count, dash, date, figure, isFigure } from './format.js';
import { table } from './tables.js';

const text = (value) =>
    value === null || value === undefined
        ? dash
        : Array.isArray(value)
          ? value.join(', ')
          : String(value);

/** `{a: {b: 1}}` as `[["a.b", "1"]]`. */
function flat(settings, prefix = '') {
    return Object.entries(settings ?? {}).flatMap(([key, value]) =>
        value !== null && typeof value === 'object' && !Array.isArray(value)
            ? flat(value, `${prefix}${key}.`)
            : [[`${prefix}${key}`, text(value)]],
    );
}

const pairs = (entries) =>
    h(
        'dl',
        { class: 'pairs' },
        ...entries.map(([key, value]) => h('div', {}, h('dt', {}, key), h('dd', {}, value))),
    );

const fold = (title, ...content) => h('details', {}, h('summary', {}, title), ...content);

/** One line for the head of the page. */
export const madeBy = (report) =>
    [`Inlay ${text(report.program)}`, date(report.date), report.machine?.cpu]
        .filter(Boolean)
        .join(' · ');

export function provenanceSection(report, ...more) {
    const machine = report.machine ?? {};
    const run = [
        ['Program', `Inlay ${text(report.program)}`],
        ['Date', date(report.date)],
        ['Repeats', text(report.repeats)],
        ['Seed', text(report.seed)],
        ['Quick run', report.quick ? 'yes: fewer frames and samples' : 'no'],
    ];
    return section(
        'provenance',
        'Machine, date and settings',
        null,
        fold(
            'Machine and run',
            pairs([
                ['Processor', text(machine.cpu)],
                ['Threads', text(machine.threads)],
                [
                    'Memory',
                    isFigure(machine.memory_gib) ? `${figure(machine.memory_gib)} GiB` : dash,
                ],
                ['System', text(machine.system)],
                ['Compiler', text(machine.compiler)],
                ...run.filter(([, value]) => value !== dash),
            ]),
        ),
        fold('Settings', pairs(flat(report.settings))),
        ...more,
    );
}

const stageColumns = ['slam', 'trace', 'filter', 'composite', 'total'].map((stage) => ({
    title: stage,
    unit: 'ms',
    value: (cell) => figure(cell.wall_ms?.[stage]?.median),
}));

const errorColumns = (reference) =>
    [
        ['rmse_influenced', 'RMSE'],
        ['relative_rmse', 'relative RMSE'],
        ['psnr', 'PSNR', 'dB'],
        ['ssim', 'SSIM'],
        ['flip', 'FLIP'],
    ].map(([key, title, unit]) => ({
        title: `${title} to ${reference}`,
        unit,
        value: (cell) => figure(cell[reference]?.[key]),
    }));

const rays = (cell) =>
    cell.rays
        ? count(
              Object.values(cell.rays)
                  .filter(isFigure)
                  .reduce((sum, each) => sum + each, 0),
          )
        : dash;

/** Every cell with all its figures, folded away. */
export function everyCell(work) {
    return fold(
        `All ${work.cells.length} cells`,
        table(
            `Every cell of ${work.title}`,
            [
                {
                    title: 'Cell',
                    text: true,
                    value: (cell) => h('span', { title: cell.id }, cellName(work, cell)),
                },
                ...stageColumns,
                ...errorColumns('converged'),
                ...errorColumns('truth'),
                {
                    title: 'Flicker',
                    unit: 'relative radiance',
                    value: (cell) => figure(cell.flicker),
                },
                { title: 'Rays', unit: 'per frame', value: rays },
                { title: 'Swept width', value: (cell) => figure(cell.width) },
                { title: 'Memory', unit: 'MB, peak', value: (cell) => figure(cell.peak_mb) },
            ],
            work.cells,
            { wide: true },
        ),
    );
}

export function methodList(report) {
    return fold(
        'Methods',
        h(
            'dl',
            { class: 'methods' },
            ...(report.methods ?? []).flatMap((method) => [
                h('dt', {}, method.title, h('span', { class: 'tag' }, method.family)),
                h('dd', {}, method.summary ?? dash),
            ]),
        ),
    );
}

/** What a cell says of its failures, a text each. */
const failuresOf = (cell) =>
    cell.failed
        ? [cell.failed]
        : (cell.failed_repeats ?? []).map(
              ({ repeat, message }) => `in repeat ${repeat + 1}, the others count: ${message}`,
          );

/** The cells that failed with their messages, or null. */
export function failedSection(work) {
    const failed = work.cells.flatMap((cell) =>
        failuresOf(cell).map((message) => ({ cell, message })),
    );
    if (failed.length === 0) return null;
    return section(
        'failed',
        'What failed',
        'A failed cell has no figures, a failed repeat is in none.',
        h(
            'ul',
            { class: 'failures' },
            ...failed.map(({ cell, message }) =>
                h('li', {}, h('strong', {}, cellName(work, cell)), ` ${message}`),
            ),
        ),
    );
}
