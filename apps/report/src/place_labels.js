// Names beside the points of a front, or their numbers, without covering one another.

const letter = 6.1; // px, mean width at the size of the names
const line = 13; // px
const mark = 5; // px, half the size of a mark

const along = (value, [low, high], length) =>
    (Math.log(value / low) / Math.log(high / low)) * length;

const overlap = (a, b) =>
    a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

/**
 * The `points` (`{ms, error, text, number}`), each with the `text` that fits left of and below it:
 * its name, else its number, else the point is left out. The axes are logarithmic, the plotted area
 * is `width` x `height` px.
 */
export function placeLabels(points, xDomain, yDomain, { width, height }) {
    const spots = points.map((point) => ({
        x: along(point.ms, xDomain, width),
        y: height - along(point.error, yDomain, height),
    }));
    const marks = spots.map(({ x, y }) => ({
        left: x - mark,
        right: x + mark,
        top: y - mark,
        bottom: y + mark,
    }));
    const placed = [];
    points.forEach((point, i) => {
        for (const text of [point.text, point.number]) {
            const { x, y } = spots[i];
            const box = {
                left: x - 9 - letter * text.length,
                right: x - 9,
                top: y + 3,
                bottom: y + 3 + line,
                point: { ...point, text },
            };
            if (
                box.left < 0 ||
                marks.some((each) => overlap(box, each)) ||
                placed.some((each) => overlap(box, each))
            )
                continue;
            placed.push(box);
            break;
        }
    });
    return placed.map((box) => box.point);
}
