// One picture over another with a handle between them, and a frame around the enlarged part.
import { h } from './dom.js';

const steps = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const clickReach = 4; // px that a pointer may move in a click

/** Percent after a key on the handle, or null where the key is not the slider's. */
export function sliderKey(percent, event) {
    const large = event.shiftKey ? 10 : 1;
    const moves = {
        ArrowLeft: -large,
        ArrowDown: -large,
        ArrowRight: large,
        ArrowUp: large,
        PageDown: -10,
        PageUp: 10,
        Home: -100,
        End: 100,
    };
    return event.key in moves ? Math.max(0, Math.min(100, percent + moves[event.key])) : null;
}

function parts() {
    const below = h('img', { alt: '', draggable: 'false' }),
        above = h('img', { alt: '', class: 'above', draggable: 'false' });
    const handle = h(
        'div',
        {
            class: 'handle',
            role: 'slider',
            tabindex: 0,
            'aria-label': 'How much of the left picture is shown',
            'aria-valuemin': 0,
            'aria-valuemax': 100,
            'aria-orientation': 'horizontal',
        },
        h('span', { class: 'grip', 'aria-hidden': 'true' }, '↔'),
    );
    const lens = h('button', {
        class: 'lens',
        type: 'button',
        'aria-label': 'Enlarged part; arrow keys move it',
    });
    const left = h('span', { class: 'corner corner-left' }),
        right = h('span', { class: 'corner corner-right' });
    const element = h('div', { class: 'comparison' }, below, above, left, right, lens, handle);
    return { element, below, above, handle, lens, left, right };
}

/** Calls `drag(event)` while a pointer moves on `element`, `click(event)` when it did not. */
function followPointer(element, handle, drag, click) {
    let start = null,
        dragging = false;
    element.addEventListener('pointerdown', (event) => {
        if (event.button !== 0) return;
        start = event;
        dragging = handle.contains(event.target);
        element.setPointerCapture(event.pointerId);
        if (dragging) handle.focus({ preventScroll: true });
        event.preventDefault();
    });
    element.addEventListener('pointermove', (event) => {
        if (!start) return;
        dragging ||= Math.abs(event.clientX - start.clientX) > clickReach;
        if (dragging) drag(event);
    });
    element.addEventListener('pointerup', (event) => {
        if (start && !dragging) click(event);
        start = null;
    });
    element.addEventListener('pointercancel', () => (start = null));
}

/** The enlarged part's frame: `place` (pixels of the picture, and its width) kept inside the picture. */
function lensOf(lens, onplace) {
    const size = { width: 1, height: 1 },
        place = { x: null, y: null, width: 48 };
    const move = (x, y) => {
        place.x = Math.max(0, Math.min(size.width - 1, Math.round(x)));
        place.y = Math.max(0, Math.min(size.height - 1, Math.round(y)));
        const height = place.width * 0.75;
        Object.assign(lens.style, {
            left: `${(100 * (place.x - place.width / 2)) / size.width}%`,
            top: `${(100 * (place.y - height / 2)) / size.height}%`,
            width: `${(100 * place.width) / size.width}%`,
            height: `${(100 * height) / size.height}%`,
        });
        onplace({ ...place });
    };
    lens.addEventListener('keydown', (event) => {
        if (!(event.key in steps)) return;
        const [dx, dy] = steps[event.key],
            length = event.shiftKey ? 10 : 1;
        move(place.x + dx * length, place.y + dy * length);
        event.preventDefault();
    });
    return { size, place, move };
}

/** The stage; `onplace({x, y, width})` hears where the enlarged part is, in pixels of the picture. */
export function comparison(onplace) {
    const { element, below, above, handle, lens, left, right } = parts();
    let percent = 50;
    const slide = (next) => {
        percent = Math.max(0, Math.min(100, next));
        above.style.clipPath = `inset(0 ${100 - percent}% 0 0)`;
        handle.style.left = `${percent}%`;
        handle.setAttribute('aria-valuenow', String(Math.round(percent)));
        handle.setAttribute('aria-valuetext', `${Math.round(percent)} % ${left.textContent}`);
    };
    handle.addEventListener('keydown', (event) => {
        const next = sliderKey(percent, event);
        if (next === null) return;
        slide(next);
        event.preventDefault();
    });
    const frame = lensOf(lens, onplace);
    const within = (event) => {
        const box = element.getBoundingClientRect();
        return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    };
    followPointer(
        element,
        handle,
        (event) => slide(100 * within(event)[0]),
        (event) => {
            const [x, y] = within(event);
            frame.move(x * frame.size.width, y * frame.size.height);
        },
    );
    return {
        element,
        show(a, b) {
            Object.assign(above, { src: a.png, alt: a.title });
            Object.assign(below, { src: b.png, alt: b.title });
            left.textContent = a.title;
            right.textContent = b.title;
            slide(percent);
        },
        /** Tells the size of the pictures, px, and where the enlarged part begins if the reader has not moved it. */
        sized(width, height, start) {
            Object.assign(frame.size, { width, height });
            frame.place.width = Math.max(8, Math.round(width / 10));
            frame.move(
                frame.place.x ?? start?.[0] ?? width / 2,
                frame.place.y ?? start?.[1] ?? height / 2,
            );
        },
    };
}
