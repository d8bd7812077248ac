// The record of a small replay as `inlay replay --report` would write it.
import { random } from './random.mjs';
import { machine, settings } from './sample_accuracy.mjs';
import { picture } from './sample_pictures.mjs';

function frame(number, next) {
    const ms = { load: 4.1, slam: 24, plan: 0.3, trace: 43, filter: 12, composite: 1.8, write: 9 };
    for (const stage of Object.keys(ms)) ms[stage] *= 0.9 + 0.25 * next();
    ms.total = Object.values(ms).reduce((sum, each) => sum + each, 0);
    const tracking =
        number >= 31 && number < 33 ? 'lost' : number >= 28 && number < 36 ? 'weak' : 'tracked';
    const wave = 1 + 0.3 * Math.sin(number / 9);
    return {
        frame: number,
        tracking,
        ms,
        rays: {
            primary: 307200,
            virtual_shadow: 240000 * wave,
            virtual_indirect: 190000 * wave,
            real_shadow: 82000 * wave,
            real_indirect: 61000 * wave,
        },
        pixels: {
            virtual: Math.round(21000 * wave),
            influenced: Math.round(64000 * wave),
            skipped: Math.round(232000 / wave),
        },
    };
}

export function sampleReplay({ width, height } = { width: 160, height: 120 }) {
    const next = random(3);
    return {
        version: 1,
        kind: 'replay',
        command: 'replay',
        program: '0.1.0',
        date: '2026-01-31T12:00:00Z',
        machine,
        settings,
        recording: 'desk',
        scene: 'scene.json',
        frames: Array.from({ length: 60 }, (_, number) => frame(number, next)),
        pictures: [0, 30].flatMap((number) =>
            ['photograph', 'composite', 'difference'].map((title) => ({
                frame: number,
                title,
                png: picture(title, width, height, { shift: number * 0.003 }),
            })),
        ),
        plan: [
            { effect: 'environment_direct', in: true, reason: 'the environment lights 3 objects' },
            {
                effect: 'environment_indirect',
                in: true,
                reason: 'diffuse objects stand on a coloured table',
            },
            { effect: 'hair', in: false, reason: 'no object has strands' },
            { effect: 'medium', in: false, reason: 'the scene has no medium' },
        ],
    };
}

/** The record of one picture as `inlay render --report` would write it. */
export function sampleRender() {
    const replay = sampleReplay();
    return {
        ...replay,
        command: 'render',
        recording: 'the view of desk',
        frames: replay.frames.slice(0, 1),
        pictures: replay.pictures.slice(0, 3),
    };
}
