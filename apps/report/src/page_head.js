// The head of a page: its name, where it comes from, the theme, and links to its sections.
import { h } from './dom.js';
import { madeBy } from './provenance.js';
import { themeToggle } from './theme.js';

export function pageHead(report, title, ...content) {
    document.title = `Inlay: ${title}`;
    return h(
        'header',
        { class: 'head' },
        h('div', { class: 'head-row' }, h('p', { class: 'brand' }, 'Inlay'), themeToggle()),
        h('h1', {}, title),
        h('p', { class: 'made-by' }, madeBy(report)),
        ...content,
    );
}

/** Links to the sections, by the headings that they have. */
export const contents = (sections) =>
    h(
        'nav',
        { class: 'contents', 'aria-label': 'Sections' },
        ...sections.map((each) =>
            h('a', { href: `#${each.id}` }, each.querySelector('h2').textContent),
        ),
    );

/** Large figures in a row; items are `[name, figure, remark]`. */
export const tiles = (items) =>
    h(
        'dl',
        { class: 'tiles' },
        ...items.map(([name, value, remark]) =>
            h(
                'div',
                {},
                h('dt', {}, name),
                h('dd', {}, value),
                remark && h('dd', { class: 'remark' }, remark),
            ),
        ),
    );
