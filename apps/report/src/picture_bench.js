// Two pictures of one frame side by side: a slider between them, their difference, and enlarged insets.
import { dropdown } from './choices.js';
import { h, section } from './dom.js';
import { differencePanel } from './difference.js';
import { insetPanel } from './insets.js';
import { loadPixels } from './pixels.js';
import { comparison } from './comparison.js';

/** Pictures by frame, in order: Map of frame -> list of `{key, title, frame, png}`. */
function byFrame(pictures) {
    const frames = new Map();
    for (const picture of [...pictures].sort((a, b) => a.frame - b.frame)) {
        if (!frames.has(picture.frame)) frames.set(picture.frame, []);
        frames.get(picture.frame).push(picture);
    }
    return frames;
}

const find = (list, key) => list.find((picture) => picture.key === key);

/** The pair to show of `list`: the wanted keys where they exist, else the first two. */
function pairOf(list, wanted) {
    const left = find(list, wanted.left) ?? list[0];
    const right = find(list, wanted.right) ?? list.find((picture) => picture !== left) ?? left;
    return { left, right };
}

function pickers(frames, state, onchange) {
    const list = frames.get(state.frame);
    const { left, right } = pairOf(list, state);
    const options = list.map((picture) => [picture.key, picture.title]);
    return [
        dropdown(
            'Frame',
            [...frames.keys()].map((frame) => [String(frame), String(frame)]),
            String(state.frame),
            (value) => onchange({ frame: Number(value) }),
        ),
        dropdown('Left', options, left.key, (value) => onchange({ left: value })),
        dropdown('Right', options, right.key, (value) => onchange({ right: value })),
    ];
}

/** The bench over `pictures` (`{key, title, frame, png}`), which begins with the pair `first` (`{left, right}`: keys). */
export function benchSection(pictures, first) {
    const frames = byFrame(pictures.filter((picture) => picture.png));
    if (frames.size === 0) return null;
    const state = { frame: [...frames.keys()][0], ...first };
    const controls = h('div', { class: 'controls' });
    const insets = insetPanel(),
        difference = differencePanel();
    const stage = comparison((place) => insets.place(place));
    let turn = 0;
    const show = async () => {
        const mine = ++turn;
        const { left, right } = pairOf(frames.get(state.frame), state);
        stage.show(left, right);
        const [a, b] = await Promise.all([loadPixels(left.png), loadPixels(right.png)]);
        if (mine !== turn) return;
        const map = difference.show(a, b);
        stage.sized(a.width, a.height, difference.busiest());
        insets.show([
            [left.title, a],
            [right.title, b],
            ['Difference', map],
        ]);
    };
    const change = (values) => {
        Object.assign(state, values);
        controls.replaceChildren(...pickers(frames, state, change));
        show();
    };
    difference.watch((map) => insets.replaceLast(map));
    change({});
    return section(
        'pictures',
        'Pictures',
        'Drag the handle, or use the arrow keys on it. A click on the picture moves the enlarged part; so do the arrow keys on its frame.',
        controls,
        h('div', { class: 'bench' }, stage.element, difference.element),
        insets.element,
    );
}
