// The difference of two pictures in false colour, with its scale.
import { choices, segments } from './choices.js';
import { h } from './dom.js';
import { paint } from './pixels.js';

// Dark to light with even steps of lightness, so that it reads without colour vision too.
const ramp = [
    [0, 0, 4],
    [29, 17, 71],
    [81, 18, 124],
    [131, 38, 129],
    [183, 55, 121],
    [231, 82, 99],
    [252, 137, 97],
    [254, 196, 136],
    [252, 253, 191],
];
const ranges = [8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 255];

/** The colour of `t` in [0, 1]. */
export function falseColour(t) {
    const at = Math.max(0, Math.min(1, t)) * (ramp.length - 1);
    const low = Math.min(ramp.length - 2, Math.floor(at));
    return ramp[low].map((channel, i) => channel + (at - low) * (ramp[low + 1][i] - channel));
}

/** Per pixel the largest difference of the three channels, in levels of 255; pictures of two sizes have none. */
export function levels(a, b) {
    if (a.width !== b.width || a.height !== b.height) return null;
    const result = new Uint8Array(a.width * a.height);
    for (let i = 0; i < result.length; ++i) {
        for (let c = 4 * i; c < 4 * i + 3; ++c)
            result[i] = Math.max(result[i], Math.abs(a.data[c] - b.data[c]));
    }
    return result;
}

function summary(values) {
    let square = 0,
        largest = 0;
    for (const value of values) {
        square += value * value;
        largest = Math.max(largest, value);
    }
    return { rms: Math.sqrt(square / values.length), largest };
}

/** The smallest range that holds all but one pixel in a thousand. */
function fittingRange(values) {
    const counts = new Uint32Array(256);
    for (const value of values) ++counts[value];
    let above = 0,
        level = 255;
    while (level > 0 && above + counts[level] <= values.length / 1000) above += counts[level--];
    return ranges.find((range) => range >= level) ?? 255;
}

/** The middle of the part, a tenth of the picture wide and high, in which the pictures differ most. */
function busiest({ values, width, height }) {
    const sums = new Float64Array(100);
    values.forEach(
        (value, i) =>
            (sums[
                10 * Math.floor((10 * Math.floor(i / width)) / height) +
                    Math.floor((10 * (i % width)) / width)
            ] += value),
    );
    const best = sums.indexOf(Math.max(...sums));
    return [(((best % 10) + 0.5) * width) / 10, ((Math.floor(best / 10) + 0.5) * height) / 10];
}

function coloured(values, width, height, range) {
    const table = Array.from({ length: 256 }, (_, level) => falseColour(level / range));
    const pixels = new ImageData(width, height);
    values.forEach((value, i) => pixels.data.set([...table[value], 255], 4 * i));
    return pixels;
}

function scale() {
    const gradient = ramp
        .map((rgb, i) => `rgb(${rgb.join(' ')}) ${(100 * i) / (ramp.length - 1)}%`)
        .join(', ');
    const middle = h('span'),
        end = h('span');
    return {
        element: h(
            'div',
            { class: 'scale' },
            h('div', {
                class: 'scale-bar',
                style: `background: linear-gradient(90deg, ${gradient})`,
            }),
            h('div', { class: 'scale-ends' }, h('span', {}, '0'), middle, end),
        ),
        show(range) {
            middle.textContent = String(range / 2);
            end.textContent = `${range}${range < 255 ? ' and more' : ''} levels of 255`;
        },
    };
}

/** `show(a, b)` draws and returns the false-colour ImageData; `watch` hears it when the range changes. */
export function differencePanel() {
    const canvas = h('canvas', {
        role: 'img',
        'aria-label': 'Difference of the two pictures in false colour',
    });
    const caption = h('p', { class: 'note', 'aria-live': 'polite' });
    const legend = scale(),
        store = choices({ range: 'fit' });
    let current = null,
        watcher = () => {};
    const draw = () => {
        if (!current) return null;
        const range =
            store.get().range === 'fit' ? fittingRange(current.values) : Number(store.get().range);
        const pixels = coloured(current.values, current.width, current.height, range);
        paint(canvas, pixels);
        legend.show(range);
        return pixels;
    };
    store.watch(() => watcher(draw()));
    return {
        element: h(
            'figure',
            { class: 'difference' },
            canvas,
            h(
                'figcaption',
                {},
                legend.element,
                caption,
                segments(store, 'range', 'Range (levels)', [
                    ['fit', 'fitting'],
                    ['16', '16'],
                    ['64', '64'],
                    ['255', '255'],
                ]),
            ),
        ),
        watch: (next) => (watcher = next),
        busiest: () => (current ? busiest(current) : null),
        show(a, b) {
            const values = levels(a, b);
            canvas.hidden = !values;
            current = values && { values, width: a.width, height: a.height };
            const figures = values && summary(values);
            caption.textContent = values
                ? `Largest difference of the three channels, per pixel. Root mean square ${figures.rms.toFixed(1)}, largest ${figures.largest} levels.`
                : 'The pictures differ in size.';
            return draw();
        },
    };
}
