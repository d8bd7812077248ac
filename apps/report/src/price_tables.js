// What unfiltered sampling takes for the same error, and what other methods reach in the same time.
import { nothing } from './chart.js';
import { h, section } from './dom.js';
import { dash, factor, figure, isFigure } from './format.js';
import { bar, table } from './tables.js';

const methodName = (work, row) =>
    h(
        'span',
        {},
        work.methods.get(row.method)?.title ?? row.method,
        h('span', { class: 'tag' }, row.temporal ? 'previous frame' : 'one frame'),
    );

/** A figure, with the sign of a bound where it is one. */
const bounded = (value, isBound, sign = '≥') =>
    isFigure(value) ? `${isBound ? `${sign} ` : ''}${figure(value)}` : dash;

function equalError(work) {
    const rows = work.equal_error ?? [];
    if (rows.length === 0) return nothing('No method was matched by error.');
    const largest = Math.max(...rows.map((row) => row.speed_up ?? 0));
    return table(
        'Equal error: the time that unfiltered sampling takes to come as close',
        [
            { title: 'Method', text: true, value: (row) => methodName(work, row) },
            {
                title: 'At',
                text: true,
                value: (row) =>
                    work.byId.has(row.anchor)
                        ? `${work.byId.get(row.anchor).samples}\u00a0spp`
                        : (row.anchor ?? dash),
            },
            { title: 'RMSE', unit: 'relative radiance', value: (row) => figure(row.error) },
            { title: 'Filtered', unit: 'ms', value: (row) => figure(row.filtered_ms) },
            {
                title: 'Unfiltered',
                unit: 'ms',
                value: (row) => bounded(row.unfiltered_ms, row.beyond),
            },
            {
                title: 'Unfiltered',
                unit: 'spp',
                value: (row) => bounded(row.unfiltered_samples, row.beyond),
            },
            { title: 'FLIP, filtered to unfiltered', value: (row) => factor(row.flip_ratio) },
            {
                title: 'Speed-up',
                value: (row) => bar(factor(row.speed_up, row.beyond), row.speed_up / largest),
            },
        ],
        rows,
    );
}

function equalTime(work) {
    const rows = work.equal_time ?? [];
    if (rows.length === 0) return nothing('No method was matched by time.');
    const largest = Math.max(...rows.flatMap((row) => [row.rmse_ratio ?? 0, row.flip_ratio ?? 0]));
    return table(
        'Equal time: the error of every method at the time of the filtered anchor',
        [
            { title: 'Method', text: true, value: (row) => methodName(work, row) },
            { title: 'Time', unit: 'ms', value: (row) => figure(row.ms) },
            {
                title: 'RMSE',
                unit: 'relative radiance',
                value: (row) => bounded(row.rmse, row.beyond, '≤'),
            },
            { title: 'FLIP', unit: '0 to 1', value: (row) => bounded(row.flip, row.beyond, '≤') },
            {
                title: 'RMSE to anchor',
                value: (row) => bar(factor(row.rmse_ratio), row.rmse_ratio / largest),
            },
            {
                title: 'FLIP to anchor',
                value: (row) => bar(factor(row.flip_ratio), row.flip_ratio / largest),
            },
        ],
        rows,
    );
}

export function priceSection(work) {
    const anchor = work.equal_time?.find((row) => row.rmse_ratio === 1 && row.flip_ratio === 1);
    const name = anchor ? ` (${work.methods.get(anchor.method)?.title ?? anchor.method})` : '';
    return section(
        'price',
        'Equal error, equal time',
        'Equal error: “≥” marks a lower bound, where unfiltered sampling did not come as close with ' +
            'its largest number of samples; FLIP below 1× looks closer than the unfiltered picture. ' +
            `Equal time: above 1× the anchor${name} is better; “≤” marks a method that was not ` +
            'measured at so long a time.',
        equalError(work),
        equalTime(work),
    );
}
