// Charts over the frames of one run.
import * as Plot from '@observablehq/plot';
import { chart, frameAxis, nothing, plot, swatches, tip } from './chart.js';
import { section } from './dom.js';
import { count, figure, isFigure, tick } from './format.js';
import { seriesColour } from './palette.js';

const stages = ['load', 'slam', 'plan', 'trace', 'filter', 'composite', 'write'];
const rays = ['primary', 'virtual_shadow', 'virtual_indirect', 'real_shadow', 'real_indirect'];
const pixels = ['virtual', 'influenced', 'skipped'];
const tracking = [
    ['tracked', 'var(--series-3)'],
    ['weak', 'var(--series-5)'],
    ['lost', 'var(--series-2)'],
];

const words = (name) => name.replaceAll('_', ' ');
const colours = (names) => new Map(names.map((name, index) => [name, seriesColour(index)]));

/** Rows `{frame, name, value}` of `group` (`ms`, `rays`, `pixels`), a row per frame and name. */
const rowsOf = (frames, group, names) =>
    frames.flatMap((frame) =>
        names
            .map((name) => ({ frame: frame.frame, name, value: frame[group]?.[name] }))
            .filter((row) => isFigure(row.value)),
    );

/** Half the smallest distance of two frames, so that bars touch. */
function halfStep(frames) {
    const numbers = [...new Set(frames.map((row) => row.frame))].sort((a, b) => a - b);
    return (
        0.5 *
        Math.min(
            ...numbers.slice(1).map((number, i) => number - numbers[i]),
            numbers.length > 1 ? Infinity : 1,
        )
    );
}

function drawStacked(rows, palette, label, width) {
    if (rows.length === 0) return nothing('No frame has these figures.');
    const half = halfStep(rows),
        numbers = rows.map((row) => row.frame);
    const bars = {
        x1: (row) => row.frame - half,
        x2: (row) => row.frame + half,
        y: 'value',
        fill: (row) => palette.get(row.name),
    };
    return plot({
        width,
        height: 300,
        x: {
            ...frameAxis(numbers, width),
            domain: [Math.min(...numbers) - half, Math.max(...numbers) + half],
        },
        y: { label, labelArrow: 'none', grid: true, nice: true, tickFormat: tick, ticks: 6 },
        marks: [
            Plot.rectY(
                rows,
                Plot.stackY({
                    ...bars,
                    order: null,
                    inset: width / numbers.length > 1 ? 0.5 : 0,
                    title: (row) =>
                        `frame ${row.frame}\n${words(row.name)}: ${figure(row.value)} ms`,
                    tip: { format: { fill: false } },
                }),
            ),
            Plot.ruleY([0]),
        ],
    });
}

function drawLines(rows, palette, label, width) {
    if (rows.length === 0) return nothing('No frame has these figures.');
    const series = [...palette.keys()].map((name) => rows.filter((row) => row.name === name));
    return plot({
        width,
        height: 260,
        x: frameAxis(
            rows.map((row) => row.frame),
            width,
        ),
        y: {
            label,
            labelArrow: 'none',
            grid: true,
            zero: true,
            nice: true,
            tickFormat: count,
            ticks: 5,
        },
        marks: [
            ...series.map((list) =>
                Plot.line(list, {
                    x: 'frame',
                    y: 'value',
                    stroke: palette.get(list[0]?.name) ?? 'none',
                    strokeWidth: 2,
                }),
            ),
            Plot.dot(rows, {
                x: 'frame',
                y: 'value',
                r: rows.length > 400 ? 1 : 2.5,
                fill: (row) => palette.get(row.name),
            }),
            tip(rows, {
                x: 'frame',
                y: 'value',
                title: (row) => `frame ${row.frame}\n${words(row.name)}: ${count(row.value)}`,
            }),
        ],
    });
}

const legend = (palette) => swatches([...palette].map(([name, colour]) => [words(name), colour]));

export function stagesSection(frames) {
    const palette = colours(stages),
        rows = rowsOf(frames, 'ms', stages);
    const bars = chart('Time of each stage, stacked, over the frames', (width) =>
        drawStacked(rows, palette, 'time per frame (ms)', width),
    );
    return section(
        'stages',
        'Time per stage',
        'Where the time of each frame goes.',
        legend(palette),
        bars.element,
    );
}

export function trackingSection(frames) {
    const known = new Map(tracking),
        rows = frames.filter((frame) => known.has(frame.tracking));
    if (rows.length === 0) return null;
    const half = halfStep(rows);
    const strip = chart('Tracking status over the frames', (width) =>
        plot({
            width,
            height: 126,
            marginLeft: 64,
            x: {
                ...frameAxis(
                    rows.map((frame) => frame.frame),
                    width,
                ),
            },
            y: {
                type: 'band',
                domain: tracking.map(([status]) => status),
                label: null,
                padding: 0.2,
            },
            marks: [
                Plot.rect(rows, {
                    x1: (frame) => frame.frame - half,
                    x2: (frame) => frame.frame + half,
                    y: 'tracking',
                    fill: (frame) => known.get(frame.tracking),
                    title: (frame) => `frame ${frame.frame}: ${frame.tracking}`,
                    tip: { format: { fill: false } },
                }),
            ],
        }),
    );
    return section(
        'tracking',
        'Tracking',
        'Lost frames keep their photograph; weak ones are followed with little to hold on to.',
        strip.element,
    );
}

export function raysSection(frames) {
    const palette = colours(rays),
        rows = rowsOf(frames, 'rays', rays);
    if (rows.length === 0) return null;
    const lines = chart('Rays of each kind over the frames', (width) =>
        drawLines(rows, palette, 'rays per frame', width),
    );
    return section(
        'rays',
        'Rays',
        'Virtual: against the objects that were put in. Real: against the real geometry.',
        legend(palette),
        lines.element,
    );
}

export function pixelsSection(frames) {
    const palette = colours(pixels),
        rows = rowsOf(frames, 'pixels', pixels);
    if (rows.length === 0) return null;
    const lines = chart('Pixels of each kind over the frames', (width) =>
        drawLines(rows, palette, 'pixels per frame', width),
    );
    return section(
        'pixels',
        'Pixels',
        'Virtual: covered by an object, at least in part. Influenced: different from the photograph. Skipped: no ray against real geometry was traced.',
        legend(palette),
        lines.element,
    );
}
