// Cells of a sample accuracy.json: errors fall and times rise with the samples.

// noise: of one sample; floor: bias; cost: of the filter, ms; temporal: it can use the frame before.
export const methods = [
    {
        name: 'unfiltered',
        title: 'Unfiltered',
        family: 'none',
        summary: 'The samples as they are.',
        noise: 0.42,
        floor: 0,
        cost: 0,
    },
    {
        name: 'axis_aligned',
        title: 'Axis-aligned filter',
        family: 'inlay',
        summary: 'Widths from bandwidths, with the corrected constants.',
        noise: 0.075,
        floor: 0.0035,
        cost: 9,
        temporal: true,
    },
    {
        name: 'axis_aligned_thesis',
        title: 'Axis-aligned, constants as printed',
        family: 'thesis',
        summary: 'The widths of the thesis as printed.',
        noise: 0.085,
        floor: 0.009,
        cost: 9,
        temporal: true,
    },
    {
        name: 'fixed_gaussian',
        title: 'Fixed Gaussian',
        family: 'baseline',
        summary: 'One width for all pixels, the best of a sweep.',
        noise: 0.1,
        floor: 0.021,
        cost: 6,
    },
    {
        name: 'cross_bilateral',
        title: 'Cross bilateral',
        family: 'baseline',
        summary: 'Guided by depth and normals.',
        noise: 0.11,
        floor: 0.014,
        cost: 31,
    },
    {
        name: 'a_trous',
        title: 'À-trous wavelets',
        family: 'baseline',
        summary: 'Edge-avoiding wavelets in five steps.',
        noise: 0.095,
        floor: 0.012,
        cost: 17,
    },
];
const knobs = {
    split: ['16x1', '8x2', '4x4', '2x8'],
    geometry: ['screen', 'model'],
    quality: ['draft', 'standard', 'reference'],
    'bounce <b>&amp;</b>': ['0', '1', '2'],
};
export const frames = [0, 1, 2, 3, 4, 10, 11, 12];

const spread = (ms) => ({ median: ms, min: ms * 0.96, max: ms * 1.07 });

function errors(rmse) {
    return {
        rmse: rmse * 0.4,
        rmse_influenced: rmse,
        relative_rmse: rmse * 1.8,
        psnr: -20 * Math.log10(rmse * 0.4),
        ssim: 1 - rmse,
        flip: 0.55 * rmse ** 0.8,
    };
}

function cell(
    method,
    samples,
    temporal,
    next,
    { knob = 'samples', value = String(samples), scale = 1 } = {},
) {
    const noise = (method.noise / Math.sqrt(samples)) * (temporal ? 0.72 : 1);
    const rmse = Math.hypot(noise, method.floor) * (0.97 + 0.06 * next()) * scale;
    const trace = (2.1 + 2.6 * samples) / scale,
        filter = method.cost * (temporal ? 1.35 : 1);
    const ms = {
        slam: spread(24),
        trace: spread(trace),
        filter: spread(filter),
        composite: spread(1.8),
        total: spread(trace + filter + 1.8),
    };
    return {
        id: `${knob}=${value}/${method.name}${temporal ? '/temporal' : ''}`,
        knob,
        value,
        method: method.name,
        temporal,
        width: method.name === 'fixed_gaussian' ? 7 : null,
        samples,
        primary: Math.min(4, samples),
        secondary: Math.max(1, samples / 4),
        wall_ms: ms,
        cpu_ms: Object.fromEntries(
            Object.entries(ms).map(([stage, each]) => [stage, spread(each.median * 1.9)]),
        ),
        rays: {
            primary: 76800,
            virtual_shadow: 9000 * samples,
            virtual_indirect: 7000 * samples,
            real_shadow: 5200 * samples,
            real_indirect: 4100 * samples,
        },
        peak_mb: 310 + samples,
        converged: errors(rmse),
        truth: errors(Math.hypot(rmse, 0.018)),
        flicker: noise * 0.7,
        frames: frames.map((frame) => {
            const here = rmse * (0.85 + 0.3 * next());
            return {
                frame,
                rmse_influenced: here,
                truth_rmse_influenced: Math.hypot(here, 0.018),
                psnr: -20 * Math.log10(here * 0.4),
                flip: 0.55 * here ** 0.8,
                ms: ms.total.median * (0.93 + 0.14 * next()),
            };
        }),
        failed: null,
    };
}

export function cellsOf(largest, next) {
    const cells = [];
    for (let samples = 1; samples <= largest; samples *= 2) {
        for (const method of methods) {
            cells.push(cell(method, samples, false, next));
            if (method.temporal) cells.push(cell(method, samples, true, next));
        }
    }
    for (const [knob, values] of Object.entries(knobs)) {
        values.forEach((value, i) =>
            cells.push(cell(methods[1], 16, true, next, { knob, value, scale: 1.25 - 0.15 * i })),
        );
    }
    const failed = cell(methods[4], 64, false, next, { knob: 'quality', value: 'reference' });
    const nulls = Object.fromEntries(
        ['wall_ms', 'cpu_ms', 'rays', 'converged', 'truth', 'flicker', 'peak_mb'].map((key) => [
            key,
            null,
        ]),
    );
    cells.push({
        ...failed,
        ...nulls,
        frames: [],
        failed: 'The filter did not finish: width 0 px at pixel (12, 7) </script>\u2028 "quoted".',
    });
    return cells;
}
