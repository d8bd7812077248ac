// Which stage the error comes from, and how well the error is estimated without a truth.
import * as Plot from '@observablehq/plot';
import { chart, logAxis, plot, swatches, tip } from './chart.js';
import { h, section } from './dom.js';
import { figure, percent } from './format.js';
import { tiles } from './page_head.js';
import { seriesColour } from './palette.js';
import { table } from './tables.js';

function drawBlame(rows, colours, width) {
    const frames = [...new Set(rows.map((row) => row.frame))];
    return plot({
        width,
        height: 60 + Math.min(420, Math.max(36, frames.length * 30)),
        marginTop: 8,
        marginLeft: 64,
        x: {
            label: 'share of the mean square error (%)',
            labelArrow: 'none',
            grid: true,
            percent: true,
            tickFormat: String,
        },
        y: {
            type: 'band',
            label: null,
            domain: frames,
            padding: 0.25,
            tickFormat: (frame) => `frame ${frame}`,
        },
        marks: [
            Plot.barX(
                rows,
                Plot.stackX({
                    x: 'share',
                    y: 'frame',
                    fill: (row) => colours.get(row.stage),
                    order: null,
                    stroke: 'var(--surface)',
                    tip: { format: { fill: false } },
                    title: (row) =>
                        `${row.stage}, frame ${row.frame}\n${percent(row.share)} of the mean square error\n` +
                        `RMSE ${figure(row.rmse)}, with the true stage ${figure(row.swapped_rmse)}`,
                }),
            ),
            Plot.ruleX([0]),
        ],
    });
}

export function blameSection(work) {
    const rows = work.blame ?? [];
    if (rows.length === 0) return null;
    const colours = new Map(
        [...new Set(rows.map((row) => row.stage))].map((stage, index) => [
            stage,
            seriesColour(index),
        ]),
    );
    const bars = chart('Share of the error of each stage, a stacked bar per frame', (width) =>
        drawBlame(
            rows.filter((row) => Number.isFinite(row.share)),
            colours,
            width,
        ),
    );
    return section(
        'blame',
        'Where the error comes from',
        'One stage at a time is given its true answer; the mean square error that goes away is its ' +
            'share. A negative share: the true answer alone makes it worse.',
        swatches([...colours]),
        bars.element,
        h(
            'details',
            {},
            h('summary', {}, 'The figures'),
            table(
                'Error with one stage made true',
                [
                    { title: 'Frame', text: true, value: (row) => String(row.frame) },
                    { title: 'Stage', text: true, value: (row) => row.stage },
                    { title: 'RMSE', unit: 'relative radiance', value: (row) => figure(row.rmse) },
                    {
                        title: 'RMSE, stage true',
                        unit: 'relative radiance',
                        value: (row) => figure(row.swapped_rmse),
                    },
                    {
                        title: 'RMSE, all stages true',
                        unit: 'relative radiance',
                        value: (row) => figure(row.best_rmse),
                    },
                    {
                        title: 'RMSE of the photograph',
                        unit: 'relative radiance',
                        value: (row) => figure(row.photograph_rmse),
                    },
                    { title: 'Share', value: (row) => percent(row.share) },
                ],
                rows,
            ),
        ),
    );
}

function drawEstimate(points, width) {
    const values = points.flatMap((point) => [point.estimated_rmse, point.true_rmse]);
    const side = Math.min(width, 460);
    const x = logAxis(values, 'estimated RMSE (relative radiance)', { most: side / 70 }),
        y = { ...x, label: 'true RMSE (relative radiance)' };
    const [low, high] = x.domain;
    return plot({
        width: side,
        height: side,
        x,
        y,
        marks: [
            Plot.line(
                [
                    [low, low],
                    [high, high],
                ],
                { stroke: 'var(--ink-soft)', strokeDasharray: '4 4' },
            ),
            Plot.dot(points, {
                x: 'estimated_rmse',
                y: 'true_rmse',
                r: 5,
                fill: 'var(--series-1)',
                fillOpacity: 0.75,
            }),
            tip(points, {
                x: 'estimated_rmse',
                y: 'true_rmse',
                title: (point) =>
                    `frame ${point.frame}\nestimated ${figure(point.estimated_rmse)}\ntrue ${figure(point.true_rmse)}`,
            }),
        ],
    });
}

export function estimateSection(work) {
    const points = (work.estimate?.frames ?? []).filter(
        (point) => point.estimated_rmse > 0 && point.true_rmse > 0,
    );
    if (points.length === 0) return null;
    const scatter = chart('Estimated against true error, a mark per frame', (width) =>
        drawEstimate(points, width),
    );
    return section(
        'estimate',
        'Error, estimated without a truth',
        'A mark per frame; on the dashed line the estimate is exact.',
        h(
            'div',
            { class: 'beside' },
            scatter.element,
            tiles([
                [
                    'Rank correlation',
                    figure(work.estimate.rank_correlation),
                    'Spearman, of the squared errors of pixels; 1: in the right order',
                ],
                [
                    'Calibration',
                    figure(work.estimate.calibration),
                    'estimated over true mean square; 1: neither too low nor too high',
                ],
            ]),
        ),
    );
}
