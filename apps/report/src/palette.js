// Colours and symbols. Colours are CSS variables, so that charts follow the theme by themselves;
// they keep apart for the three common kinds of colour blindness, and symbols differ as well.

const symbols = ['circle', 'square', 'triangle', 'diamond', 'star', 'wye', 'cross'];
const colours = 7;

export const seriesColour = (index) => `var(--series-${(index % colours) + 1})`;

/** The look of a method that the data does not list. */
export const plainLook = { colour: 'var(--ink-soft)', symbol: 'circle', strokeWidth: 1.5 };

/** The look of each method by name: unfiltered in ink, Inlay's own first, everything else after it. */
export function methodLooks(methods) {
    const looks = new Map();
    const coloured = methods.filter((method) => method.family !== 'none');
    coloured.sort((a, b) => Number(b.family === 'inlay') - Number(a.family === 'inlay'));
    for (const method of methods) {
        const index = coloured.indexOf(method);
        looks.set(
            method.name,
            index < 0
                ? { colour: 'var(--ink-soft)', symbol: 'times', strokeWidth: 2 }
                : {
                      colour: seriesColour(index),
                      symbol: symbols[(index + Math.floor(index / colours)) % symbols.length],
                      strokeWidth: method.family === 'inlay' ? 2.5 : 1.5,
                  },
        );
    }
    return looks;
}
