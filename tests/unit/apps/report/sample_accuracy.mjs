// A small accuracy.json as `inlay accuracy` would write it.
import { random } from './random.mjs';
import { cellsOf, frames, methods } from './sample_cells.mjs';
import { picture } from './sample_pictures.mjs';

function front(cells, error) {
    const ids = [];
    let best = Infinity;
    for (const each of cells
        .filter((one) => !one.failed)
        .sort((a, b) => a.wall_ms.total.median - b.wall_ms.total.median)) {
        if (each.converged[error] >= best) continue;
        best = each.converged[error];
        ids.push(each.id);
    }
    return ids;
}

const find = (cells, method, samples, temporal = false) =>
    cells.find(
        (each) =>
            each.knob === 'samples' &&
            each.method === method &&
            each.samples === samples &&
            each.temporal === temporal,
    );

function equalError(cells) {
    return methods
        .slice(1)
        .flatMap((method) =>
            [false, true].map((temporal) => find(cells, method.name, 16, temporal)).filter(Boolean),
        )
        .map((anchor) => {
            const wanted = (methods[0].noise / anchor.converged.rmse_influenced) ** 2,
                beyond = wanted > 256;
            const samples = Math.min(256, wanted),
                unfiltered = 3.9 + 2.6 * samples;
            return {
                method: anchor.method,
                temporal: anchor.temporal,
                anchor: anchor.id,
                error: anchor.converged.rmse_influenced,
                unfiltered_ms: unfiltered,
                filtered_ms: anchor.wall_ms.total.median,
                speed_up: unfiltered / anchor.wall_ms.total.median,
                unfiltered_samples: samples,
                flip_ratio: 0.8 + samples / 2000,
                beyond,
            };
        })
        .sort((a, b) => b.speed_up - a.speed_up);
}

function equalTime(cells) {
    const anchor = find(cells, 'axis_aligned', 16, true);
    return methods.map((method) => {
        const same = find(cells, method.name, 16, Boolean(method.temporal));
        const { rmse_influenced: rmse, flip } = same.converged;
        return {
            method: method.name,
            temporal: same.temporal,
            ms: anchor.wall_ms.total.median,
            rmse,
            flip,
            rmse_ratio: rmse / anchor.converged.rmse_influenced,
            flip_ratio: method.name === 'a_trous' ? null : flip / anchor.converged.flip,
            beyond: method.name === 'fixed_gaussian',
        };
    });
}

function picturesOf(cells, width, height) {
    const kinds = [
        ['photograph', 'Photograph', 'photograph', {}],
        [find(cells, 'unfiltered', 16).id, 'Unfiltered, 16 spp', 'composite', { noise: 0.12 }],
        [
            find(cells, 'axis_aligned', 16, true).id,
            'Axis-aligned filter, 16 spp',
            'composite',
            { noise: 0.008 },
        ],
        ['converged', 'Converged', 'composite', {}],
        ['truth', 'Truth', 'composite', { shift: 0.002 }],
    ];
    return [0, 10].flatMap((frame) =>
        kinds.map(([key, title, kind, options]) => ({
            cell: key,
            title,
            frame,
            png: picture(kind, width, height, {
                ...options,
                shift: (options.shift ?? 0) + frame * 0.004,
                seed: frame + 1,
            }),
        })),
    );
}

function blame() {
    const shares = {
        poses: 0.21,
        geometry: 0.34,
        sampling: 0.26,
        filter: 0.12,
        composite: 0.07,
    };
    return frames.slice(0, 5).flatMap((frame, i) =>
        Object.entries(shares).map(([stage, share], j) => {
            const here = share * (1 + 0.25 * Math.sin(3 * i + 5 * j)),
                rmse = 0.024 + 0.001 * i;
            return {
                frame,
                stage,
                share: i === 2 && j === 4 ? -0.04 : here,
                rmse,
                swapped_rmse: rmse * Math.sqrt(1 - here),
                best_rmse: rmse * 0.3,
                photograph_rmse: 0.21,
            };
        }),
    );
}

/** Frame 1 is over its budget of flicker. */
const budget = () =>
    frames.slice(0, 5).map((frame, i) => ({
        frame,
        kept: i !== 1,
        figures: [
            { figure: 'RMSE', value: 0.024 + 0.001 * i, allowed: 0.06 },
            { figure: 'E_R', value: 0.09, allowed: 0.12 },
            { figure: 'E_RV', value: 0.095, allowed: 0.12 },
            { figure: 'flicker', value: i === 1 ? 0.03 : 0.01, allowed: 0.025 },
        ],
        photograph_rmse: 0.21,
        compared: 0.97,
        parts: {
            equation: 0,
            room_as_seen: 0.01,
            sampling: 0.008,
            displacement: 0.03,
            displaced_px: 0.45,
            largest_displaced_px: 1.1,
        },
    }));

function work(name, title, kind, { largest, truth, width, height }, next) {
    const cells = cellsOf(largest, next);
    if (!truth) for (const each of cells) each.truth = null;
    return {
        name,
        title,
        kind,
        width: 320,
        height: 240,
        frames,
        environment_bandwidth: 4.31,
        reference: {
            converged_samples: 4096,
            converged_standard_error: 0.0011,
            truth_samples: truth ? 16384 : null,
            truth_standard_error: truth ? 0.0007 : null,
        },
        cells,
        fronts: { rmse: front(cells, 'rmse_influenced'), flip: front(cells, 'flip') },
        equal_error: equalError(cells),
        equal_time: equalTime(cells),
        pictures: picturesOf(cells, width, height),
        blame: truth ? blame() : null,
        budget: truth ? budget() : null,
        estimate: truth
            ? {
                  rank_correlation: 0.83,
                  calibration: 1.12,
                  frames: frames.map((frame) => {
                      const right = 0.02 + 0.012 * next();
                      return {
                          frame,
                          estimated_rmse: right * (0.85 + 0.4 * next()),
                          true_rmse: right,
                      };
                  }),
              }
            : null,
    };
}

export const machine = {
    cpu: 'AMD EPYC 7R13 48-Core Processor',
    threads: 8,
    memory_gib: 31.2,
    system: 'Debian GNU/Linux 12, Linux 6.1.0',
    compiler: 'GNU 12.2.0',
};
export const settings = {
    'filter.constants': 'corrected',
    'filter.temporal': true,
    'slam.fusion.voxel_size': 0.005,
    'slam.fusion.truncation': 0.02,
    'trace.samples': 16,
    'trace.secondary': 4,
};

export function sampleAccuracy(size = { width: 160, height: 120 }) {
    const next = random(7);
    return {
        version: 1,
        program: '0.1.0',
        date: '2026-01-31T12:00:00Z',
        machine,
        settings,
        repeats: 5,
        seed: 1,
        quick: false,
        methods: methods.map(({ name, title, family, summary }) => ({
            name,
            title,
            family,
            summary,
        })),
        works: [
            work(
                'desk',
                'Desk, synthetic recording',
                'recording',
                { ...size, largest: 256, truth: true },
                next,
            ),
            work(
                'room',
                'Room & <b>window</b>',
                'scene',
                { ...size, largest: 16, truth: false },
                next,
            ),
        ],
    };
}
