// The same small part of several pictures, enlarged without smoothing.
import { h } from './dom.js';
import { paint } from './pixels.js';

const aspect = 0.75;

function view() {
    const canvas = h('canvas', { width: 320, height: 240, role: 'img' });
    const caption = h('figcaption');
    return { canvas, caption, element: h('figure', { class: 'inset' }, canvas, caption) };
}

function enlarge(canvas, source, { x, y, width }) {
    const context = canvas.getContext('2d');
    context.imageSmoothingEnabled = false;
    context.clearRect(0, 0, canvas.width, canvas.height);
    context.drawImage(
        source,
        x - width / 2,
        y - (width * aspect) / 2,
        width,
        width * aspect,
        0,
        0,
        canvas.width,
        canvas.height,
    );
}

/** `show([[title, ImageData], ...])`, `place({x, y, width})` in pixels of the pictures. */
export function insetPanel() {
    const element = h('div', { class: 'insets' });
    let views = [],
        spot = null;
    const draw = () => {
        if (!spot) return;
        for (const each of views) {
            each.view.canvas.setAttribute(
                'aria-label',
                `${each.title}, enlarged around pixel ${spot.x}, ${spot.y}`,
            );
            each.view.canvas.hidden = !each.pixels;
            if (each.pixels) enlarge(each.view.canvas, each.source, spot);
            each.view.caption.textContent = `${each.title}, ${spot.width} px wide at (${spot.x}, ${spot.y})`;
        }
    };
    const use = (each, pixels) => {
        each.pixels = pixels;
        if (pixels) paint(each.source, pixels);
    };
    return {
        element,
        show(pictures) {
            views = pictures.map(([title, pixels]) => {
                const each = { title, view: view(), source: document.createElement('canvas') };
                use(each, pixels);
                return each;
            });
            element.replaceChildren(...views.map((each) => each.view.element));
            draw();
        },
        replaceLast(pixels) {
            if (views.length > 0) use(views.at(-1), pixels);
            draw();
        },
        place(next) {
            spot = next;
            draw();
        },
    };
}
