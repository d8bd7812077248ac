// The price list: a page over `accuracy.json`, one work at a time.
import { blameSection, estimateSection } from './blame.js';
import { budgetSection } from './budget.js';
import { cellName, indexWork } from './cells.js';
import { choices, segments } from './choices.js';
import { h } from './dom.js';
import { errorTimeSection } from './error_time_section.js';
import { dash, factor, figure, isFigure, ranges, withUnit } from './format.js';
import { frameSection } from './frame_series.js';
import { knobsSection } from './knobs.js';
import { contents, pageHead, tiles } from './page_head.js';
import { methodLooks } from './palette.js';
import { benchSection } from './picture_bench.js';
import { priceSection } from './price_tables.js';
import { everyCell, failedSection, methodList, provenanceSection } from './provenance.js';

function largestSpeedUp(work) {
    const rows = (work.equal_error ?? []).filter((row) => isFigure(row.speed_up));
    const own = rows.filter((row) => work.methods.get(row.method)?.family === 'inlay');
    return (own.length > 0 ? own : rows).reduce(
        (best, row) => (!best || row.speed_up > best.speed_up ? row : best),
        null,
    );
}

function workTiles(work) {
    const best = largestSpeedUp(work),
        anchor = best && work.byId.get(best.anchor),
        reference = work.reference ?? {};
    return tiles([
        [
            'Largest speed-up at equal error',
            best ? factor(best.speed_up, best.beyond) : dash,
            anchor
                ? `${cellName(work, anchor)}: ${withUnit(best.filtered_ms, 'ms')} instead of ${best.beyond ? 'more than ' : ''}${withUnit(best.unfiltered_ms, 'ms')}`
                : null,
        ],
        [
            'Picture',
            `${work.width} × ${work.height}\u00a0px`,
            `${work.kind}, ${work.frames?.length ?? 0} ${work.frames?.length === 1 ? 'frame' : 'frames'}: ${ranges(work.frames)}`,
        ],
        [
            'Lighting bandwidth',
            isFigure(work.environment_bandwidth)
                ? withUnit(work.environment_bandwidth, '1/rad')
                : dash,
            'how fast the light changes with direction',
        ],
        [
            'Converged reference',
            withUnit(reference.converged_samples, 'spp'),
            `±\u00a0${figure(reference.converged_standard_error)}; truth: ${
                isFigure(reference.truth_samples)
                    ? `${withUnit(reference.truth_samples, 'spp')}, ±\u00a0${figure(reference.truth_standard_error)}`
                    : dash
            }`,
        ],
    ]);
}

/** What the picture bench begins with: unfiltered against the first anchor. */
function firstPair(work, pictures) {
    const plain = pictures.find(
        (picture) => work.methods.get(work.byId.get(picture.key)?.method)?.family === 'none',
    );
    const own =
        pictures.find((picture) => picture.key === work.equal_error?.[0]?.anchor) ??
        pictures.find(
            (picture) => work.methods.get(work.byId.get(picture.key)?.method)?.family === 'inlay',
        );
    return { left: plain?.key, right: own?.key };
}

function workSections(report, work) {
    const pictures = (work.pictures ?? []).map((picture) => ({ ...picture, key: picture.cell }));
    return [
        errorTimeSection(work),
        priceSection(work),
        knobsSection(work),
        frameSection(work),
        budgetSection(work),
        benchSection(pictures, firstPair(work, pictures)),
        blameSection(work),
        estimateSection(work),
        failedSection(work),
        provenanceSection(report, methodList(report), everyCell(work)),
    ].filter(Boolean);
}

/** The children of the page. */
export function accuracyPage(report) {
    const looks = methodLooks(report.methods ?? []);
    const works = (report.works ?? []).map((work) => indexWork(report, work, looks));
    if (works.length === 0) throw new Error('it holds no work');
    const store = choices({ work: works[0].name });
    const main = h('main');
    const update = () => {
        const work = works.find((each) => each.name === store.get().work);
        const sections = workSections(report, work);
        main.replaceChildren(
            h('h2', { class: 'work-title' }, work.title),
            workTiles(work),
            contents(sections),
            ...sections,
        );
    };
    store.watch(update);
    update();
    return [
        pageHead(
            report,
            'What accuracy costs in time',
            report.quick &&
                h(
                    'p',
                    { class: 'notice' },
                    'A quick run: fewer frames and samples, so figures are rough.',
                ),
            works.length > 1 &&
                segments(
                    store,
                    'work',
                    'Work',
                    works.map((work) => [work.name, work.title]),
                ),
        ),
        main,
    ];
}
