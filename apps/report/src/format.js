// Figures as text: three significant digits, a dash where there is none.

export const dash = '–';

const short = new Intl.NumberFormat('en', { maximumSignificantDigits: 3, useGrouping: false });
const precise = new Intl.NumberFormat('en', {
    minimumSignificantDigits: 3,
    maximumSignificantDigits: 3,
});
const grouped = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });
const superscripts = {
    '-': '⁻',
    0: '⁰',
    1: '¹',
    2: '²',
    3: '³',
    4: '⁴',
    5: '⁵',
    6: '⁶',
    7: '⁷',
    8: '⁸',
    9: '⁹',
};

export const isFigure = (value) => typeof value === 'number' && Number.isFinite(value);

function shown(value, format) {
    if (!isFigure(value)) return dash;
    const size = Math.abs(value);
    if (size >= 1000) return grouped.format(value);
    if (size === 0 || size >= 1e-3) return format.format(value);
    const [digits, exponent] = value.toExponential(1).split('e');
    return `${digits} · 10${[...String(Number(exponent))].map((sign) => superscripts[sign]).join('')}`;
}

/** 0.0120, 412, 12,345, 3.2 · 10⁻⁵; whole numbers as they are. */
export const figure = (value) => shown(value, Number.isInteger(value) ? short : precise);

/** As a figure, without zeros at its end: 0.05. */
export const tick = (value) => shown(value, short);

export const withUnit = (value, unit) => (isFigure(value) ? `${figure(value)}\u00a0${unit}` : dash);

export const percent = (fraction) =>
    isFigure(fraction)
        ? `${(100 * fraction).toFixed(Math.abs(fraction) < 0.0995 ? 1 : 0)} %`
        : dash;

/** A factor; `bound` where it is known to be at least that. */
export const factor = (value, bound = false) =>
    isFigure(value) ? `${bound ? '≥ ' : ''}${shown(value, precise)}×` : dash;

/** Counts of rays or pixels: 950, 12.3 k, 4.56 M. */
export function count(value) {
    if (!isFigure(value)) return dash;
    if (Math.abs(value) >= 1e6) return `${figure(value / 1e6)} M`;
    if (Math.abs(value) >= 1e4) return `${figure(value / 1e3)} k`;
    return figure(Math.round(value));
}

/** `2026-01-31T12:00:00Z` as `31 January 2026, 12:00 UTC`; other texts as they are. */
export function date(text) {
    const time = new Date(text);
    if (!text || Number.isNaN(time.getTime())) return text || dash;
    const day = new Intl.DateTimeFormat('en-GB', { dateStyle: 'long', timeZone: 'UTC' }).format(
        time,
    );
    return `${day}, ${time.toISOString().slice(11, 16)} UTC`;
}

/** A list of frames as ranges: 0–4, 8, 10. */
export function ranges(numbers) {
    const parts = [];
    for (const number of numbers ?? []) {
        const last = parts.at(-1);
        if (last && number === last[1] + 1) last[1] = number;
        else parts.push([number, number]);
    }
    return (
        parts
            .map(([first, last]) => (first === last ? `${first}` : `${first}–${last}`))
            .join(', ') || dash
    );
}

export function median(values) {
    const sorted = values.filter(isFigure).sort((a, b) => a - b);
    if (sorted.length === 0) return null;
    const middle = sorted.length >> 1;
    return sorted.length % 2 ? sorted[middle] : (sorted[middle - 1] + sorted[middle]) / 2;
}
