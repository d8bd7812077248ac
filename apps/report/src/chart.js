// A chart that is drawn again whenever its width changes, and what all charts have in common.
import * as Plot from '@observablehq/plot';
import { h } from './dom.js';
import { tick as tickText } from './format.js';

/** A frame for `draw(width)`, which returns an SVG; `redraw` after a change of what is drawn. */
export function chart(label, draw) {
    const element = h('div', { class: 'chart', role: 'img', 'aria-label': label });
    let width = 0;
    const redraw = () => {
        if (width > 0) element.replaceChildren(draw(width));
    };
    new ResizeObserver(([entry]) => {
        const next = Math.floor(entry.contentRect.width);
        if (next === width) return;
        width = next;
        redraw();
    }).observe(element);
    return { element, redraw };
}

/** Room around the plotted area, px. */
export const margin = { top: 10, right: 16, bottom: 42, left: 56 };

/**
 * Plot with the page's type and colours; colours in the data are CSS colours. The title of the
 * vertical axis stands above the chart as text, because text wraps on a phone.
 */
export function plot({ x, y, marks, ...options }) {
    const chosen = (axis) => (axis.type === 'log' ? { ...axis, axis: null } : axis);
    const axes = [
        x.type === 'log'
            ? [
                  Plot.gridX(x.ticks),
                  Plot.axisX(x.ticks, { text: tickText, label: x.label, labelArrow: 'none' }),
              ]
            : [],
        y.type === 'log'
            ? [Plot.gridY(y.ticks), Plot.axisY(y.ticks, { text: tickText, label: null })]
            : [],
    ];
    const svg = Plot.plot({
        marginTop: margin.top,
        marginRight: margin.right,
        marginBottom: margin.bottom,
        marginLeft: margin.left,
        ...options,
        x: chosen(x),
        y: { ...chosen(y), label: null },
        marks: [...axes.flat(), ...marks],
        color: { type: 'identity' },
        style: {
            background: 'none',
            color: 'var(--ink-soft)',
            fontFamily: 'inherit',
            fontSize: '12px',
            overflow: 'visible',
        },
    });
    return y.label ? h('div', {}, h('p', { class: 'axis-title' }, y.label), svg) : svg;
}

/** What the pointer is nearest to, with its `title`. */
export const tip = (data, { x, y, title }) =>
    Plot.tip(
        data,
        Plot.pointer({ x, y, title, fontSize: 12, lineHeight: 1.35, stroke: 'var(--line)' }),
    );

/** Where nothing can be drawn: a sentence in the chart's place. */
export const nothing = (sentence) => h('p', { class: 'nothing' }, sentence);

const tickSteps = [
    [1, 1.2, 1.5, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9],
    [1, 1.5, 2, 3, 5, 7],
    [1, 2, 5],
    [1, 3],
    [1],
];

/** A logarithmic axis over `values` (> 0), with as many round ticks as `most` allows. */
export function logAxis(values, label, { low = 1.25, high = 1.25, most = 8 } = {}) {
    const domain = [Math.min(...values) / low, Math.max(...values) * high];
    const decades = Math.log10(domain[1] / domain[0]);
    const steps = tickSteps.find((each) => each.length * decades <= most) ?? [1];
    const ticks = [];
    for (let e = Math.floor(Math.log10(domain[0])); e <= Math.ceil(Math.log10(domain[1])); ++e) {
        for (const step of steps) ticks.push(Number(`${step}e${e}`));
    }
    return {
        type: 'log',
        domain,
        label,
        ticks: ticks.filter((tick) => tick >= domain[0] && tick <= domain[1]),
    };
}

/** A linear axis of frame numbers with whole ticks. */
export function frameAxis(frames, width) {
    const first = Math.min(...frames),
        last = Math.max(...frames);
    const spread = Math.max(1, last - first);
    const step =
        [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].find((each) => spread / each <= width / 70) ??
        2000;
    const ticks = [];
    for (let tick = Math.ceil(first / step) * step; tick <= last; tick += step) ticks.push(tick);
    return {
        label: 'frame',
        labelArrow: 'none',
        ticks,
        tickFormat: String,
        domain: first === last ? [first - 1, last + 1] : undefined,
    };
}

/** A legend of coloured squares; items are `[text, colour]`. */
export const swatches = (items) =>
    h(
        'ul',
        { class: 'swatches' },
        ...items.map(([text, colour]) =>
            h('li', {}, h('span', { class: 'swatch', style: `background: ${colour}` }), text),
        ),
    );
