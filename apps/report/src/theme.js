// Light or dark: as the system says until the reader says otherwise, for as long as the page is open.
import { h } from './dom.js';

const system = matchMedia('(prefers-color-scheme: dark)');
const root = document.documentElement;
let chosen = null;

const current = () => chosen ?? (system.matches ? 'dark' : 'light');

function apply() {
    root.dataset.theme = current();
    for (const button of document.querySelectorAll('.theme-toggle')) label(button);
}

function label(button) {
    const other = current() === 'dark' ? 'light' : 'dark';
    button.textContent = other === 'dark' ? '☾' : '☀';
    button.setAttribute('aria-label', `Use the ${other} theme`);
    button.title = `Use the ${other} theme`;
}

export function followTheme() {
    system.addEventListener('change', apply);
    apply();
}

export function themeToggle() {
    const button = h('button', {
        class: 'theme-toggle',
        type: 'button',
        onclick: () => {
            chosen = current() === 'dark' ? 'light' : 'dark';
            apply();
        },
    });
    label(button);
    return button;
}
