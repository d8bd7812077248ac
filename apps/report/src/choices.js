// What the reader has chosen, and the controls that show and change it.
import { h } from './dom.js';

/** A record of values; `watch` calls back after each change, `set` merges new values into it. */
export function choices(initial) {
    let values = initial;
    const watchers = [];
    return {
        get: () => values,
        set(change) {
            values = { ...values, ...change };
            watchers.forEach((watcher) => watcher(values));
        },
        watch: (watcher) => watchers.push(watcher),
    };
}

let groups = 0;

/** Radio buttons in a row for the value `key`; options are `[value, text]`. */
export function segments(store, key, title, options) {
    const name = `choice-${groups++}`;
    const buttons = options.map(([value, text]) => {
        const input = h('input', {
            type: 'radio',
            name,
            value,
            onchange: () => store.set({ [key]: value }),
        });
        return { value, input, element: h('label', {}, input, h('span', {}, text)) };
    });
    const show = () =>
        buttons.forEach((button) => (button.input.checked = store.get()[key] === button.value));
    store.watch(show);
    show();
    return h(
        'fieldset',
        { class: 'segments' },
        h('legend', {}, title),
        h('div', {}, ...buttons.map((button) => button.element)),
    );
}

/** A list to choose from; `options` are `[value, text]`. */
export function dropdown(title, options, value, onchange) {
    const select = h(
        'select',
        { onchange: () => onchange(select.value) },
        ...options.map(([each, text]) =>
            h('option', { value: each, selected: each === value }, text),
        ),
    );
    return h('label', { class: 'dropdown' }, h('span', {}, title), select);
}
