// One run of `inlay replay`, or one picture of `inlay render`: time, tracking, rays, pixels, pictures and the effect plan.
import { h, section } from './dom.js';
import { dash, figure, isFigure, median, percent, ranges, withUnit } from './format.js';
import { contents, pageHead, tiles } from './page_head.js';
import { benchSection } from './picture_bench.js';
import { provenanceSection } from './provenance.js';
import { pixelsSection, raysSection, stagesSection, trackingSection } from './run_charts.js';
import { table } from './tables.js';

/** What a command did, for the heading. */
const deeds = { replay: 'Replay', render: 'Picture' };

function runTiles(report, frames) {
    const having = (status) => frames.filter((frame) => frame.tracking === status).length;
    const total = median(frames.map((frame) => frame.ms?.total));
    return tiles([
        ['Frames', String(frames.length), ranges(frames.map((frame) => frame.frame))],
        [
            'Time per frame',
            withUnit(total, 'ms'),
            isFigure(total) ? `median; ${figure(1000 / total)} frames a second` : 'median',
        ],
        [
            'Tracked',
            frames.length > 0 ? percent(having('tracked') / frames.length) : dash,
            `${having('weak')} weak, ${having('lost')} lost`,
        ],
        [
            'Influenced pixels',
            figure(median(frames.map((frame) => frame.pixels?.influenced))),
            'median of the frames',
        ],
    ]);
}

function planSection(plan) {
    if (!plan?.length) return null;
    return section(
        'plan',
        'Effect plan',
        'What the scene calls for is simulated, and nothing else.',
        table(
            'Effects and the reasons for them',
            [
                {
                    title: 'Effect',
                    text: true,
                    value: (row) => String(row.effect).replaceAll('_', ' '),
                },
                {
                    title: 'Simulated',
                    text: true,
                    value: (row) =>
                        h(
                            'span',
                            { class: row.in ? 'answer answer-in' : 'answer' },
                            row.in ? 'yes' : 'no',
                        ),
                },
                { title: 'Reason', text: true, value: (row) => row.reason ?? dash },
            ],
            plan,
        ),
    );
}

/** The children of the page. */
export function replayPage(report) {
    const frames = report.frames ?? [];
    const pictures = (report.pictures ?? []).map((picture) => ({ ...picture, key: picture.title }));
    const sections = [
        stagesSection(frames),
        trackingSection(frames),
        benchSection(pictures, { left: 'photograph', right: 'composite' }),
        raysSection(frames),
        pixelsSection(frames),
        planSection(report.plan),
        provenanceSection(report),
    ].filter(Boolean);
    return [
        pageHead(
            report,
            `${deeds[report.command] ?? deeds.replay} of ${report.recording ?? 'a recording'}`,
            h('p', { class: 'made-by' }, `Scene: ${report.scene ?? dash}`),
        ),
        h('main', {}, runTiles(report, frames), contents(sections), ...sections),
    ];
}
