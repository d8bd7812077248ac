// Tables from columns and rows; on a phone each row becomes a card.
import { h } from './dom.js';

function headCell({ title, unit, text }) {
    return h(
        'th',
        { scope: 'col', class: text ? null : 'number' },
        title,
        unit && h('span', { class: 'unit' }, ` ${unit}`),
    );
}

function bodyCell({ title, unit, text, value }, row, index) {
    const label = unit ? `${title} (${unit})` : title;
    const attributes = { 'data-label': label, class: text ? null : 'number' };
    return index === 0
        ? h('th', { ...attributes, scope: 'row' }, value(row))
        : h('td', attributes, h('span', {}, value(row)));
}

/**
 * A table of `rows`. A column is `{title, unit, text, value}`: `value(row)` gives what the cell
 * shows, `text` columns stand left, the others are figures. The first column names the row.
 * `wide`: too many columns for cards, the table scrolls within itself; `dense`: few enough for a phone.
 */
export function table(caption, columns, rows, { wide = false, dense = false } = {}) {
    const element = h(
        'table',
        { class: wide ? 'wide' : dense ? 'dense' : 'cards' },
        h('caption', {}, caption),
        h('thead', {}, h('tr', {}, ...columns.map(headCell))),
        h(
            'tbody',
            {},
            ...rows.map((row) =>
                h('tr', {}, ...columns.map((column, index) => bodyCell(column, row, index))),
            ),
        ),
    );
    return wide
        ? h(
              'div',
              { class: 'scroller', tabindex: 0, role: 'region', 'aria-label': caption },
              element,
          )
        : element;
}

/** A figure with a bar as long as `fraction` of the cell. */
export const bar = (text, fraction, colour = 'var(--accent)') =>
    h(
        'span',
        { class: 'bar' },
        h('span', {
            class: 'bar-fill',
            style: `width: ${100 * Math.max(0, Math.min(1, fraction || 0))}%; background: ${colour}`,
        }),
        h('span', { class: 'bar-text' }, text),
    );
