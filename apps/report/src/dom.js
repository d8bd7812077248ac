// Elements as expressions; text from the data only ever becomes text nodes.

/** An element with attributes, listeners (`onclick`, ...) and children; null and false are left out. */
export function h(tag, attributes = {}, ...children) {
    const element = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) {
        if (value === null || value === undefined || value === false) continue;
        if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
        else element.setAttribute(name, value === true ? '' : value);
    }
    element.append(
        ...children
            .flat()
            .filter((child) => child !== null && child !== undefined && child !== false),
    );
    return element;
}

/** A section of the page with an id to link to, a heading, a sentence that explains it, and content. */
export function section(id, title, explanation, ...content) {
    return h(
        'section',
        { id, class: 'card', 'aria-labelledby': `${id}-title` },
        h('h2', { id: `${id}-title` }, title),
        explanation && h('p', { class: 'explanation' }, explanation),
        ...content,
    );
}
