// A ball on a table before a wall, with and without the ball, with noise.
import { pngUrl } from './png.mjs';
import { random } from './random.mjs';

function background(u, v) {
    const wood = 0.03 * Math.sin(40 * u + 6 * Math.sin(9 * v));
    return v < 0.45
        ? [0.72 - 0.2 * u, 0.74 - 0.2 * u, 0.7 - 0.16 * u]
        : [0.55 + wood, 0.42 + wood, 0.3 + wood];
}

function ball(u, v) {
    const x = (u - 0.5) / 0.16,
        y = (v - 0.5) / 0.213,
        inside = 1 - x * x - y * y;
    if (inside <= 0) return null;
    const light = Math.max(0.12, -0.45 * x - 0.6 * y + 0.66 * Math.sqrt(inside));
    return [0.25 * light, 0.62 * light, 0.9 * light];
}

const shadow = (u, v) =>
    v < 0.45 ? 1 : 1 - 0.65 * Math.exp(-(((u - 0.58) / 0.16) ** 2) - ((v - 0.72) / 0.06) ** 2);

function composite(u, v) {
    return ball(u, v) ?? background(u, v).map((value) => value * shadow(u, v));
}

/** The picture `kind` (`photograph`, `composite`, `difference`) as a data URL; `noise` is a standard deviation near the ball. */
export function picture(kind, width, height, { noise = 0, shift = 0, seed = 1 } = {}) {
    const next = random(seed);
    return pngUrl(width, height, (x, y) => {
        const u = (x + 0.5) / width + shift,
            v = (y + 0.5) / height;
        if (kind === 'photograph') return background(u, v);
        const with_ball = composite(u, v);
        if (kind === 'difference')
            return background(u, v).map((value, c) => 0.5 + with_ball[c] - value);
        const near = ball(u, v) !== null || shadow(u, v) < 0.98;
        return with_ball.map(
            (value) => value + (near ? noise * (next() + next() + next() - 1.5) * 2 : 0),
        );
    });
}
