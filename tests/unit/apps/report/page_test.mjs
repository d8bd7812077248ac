// Opens report pages in Chromium and checks what a reader would see.
// usage: node page_test.mjs (accuracy|replay|render|sparse|refusal FILE)...
import assert from 'node:assert/strict';
import { pathToFileURL } from 'node:url';
import { startBrowser } from './browser.mjs';
import * as common from './page_checks.mjs';

const text = (page, selector) => page.evaluate(`document.querySelector('${selector}').innerText`);
const choose = (page, section, value) =>
    page.evaluate(`document.querySelector('#${section} input[value=${value}]').click()`);
const lines = (page) =>
    page.evaluate("document.querySelectorAll('#error-time .chart [aria-label=line] path').length");

async function drawsALinePerMethod(page) {
    const method = 8,
        front = 1; // 6 methods, 2 of which with and without the previous frame
    assert.equal(await lines(page), method + front);
    await page.evaluate("document.querySelector('#error-time .legend button:last-child').click()");
    assert.equal(await lines(page), method - 1 + front);
    await page.evaluate("document.querySelector('#error-time .legend button:last-child').click()");
}

async function namesTheFront(page) {
    const names = await page.evaluate(
        "[...document.querySelectorAll('#error-time svg text')].map((each) => each.textContent)",
    );
    assert.ok(names.includes('Unfiltered · 1 spp'), names.join('; '));
    assert.match(await text(page, '#error-time .front-table summary'), /\d+ settings/);
}

async function followsTheChoice(page) {
    const title = () => text(page, '#error-time .axis-title');
    assert.match(await title(), /RMSE.*converged/);
    await choose(page, 'error-time', 'flip');
    await choose(page, 'error-time', 'truth');
    assert.match(await title(), /FLIP.*truth/);
    await choose(page, 'error-time', 'without');
    assert.equal(await lines(page), 7); // 6 methods and the front
}

async function showsBoundsAndDashes(page) {
    assert.match(await text(page, '#price'), /≥ \d/);
    assert.match(await text(page, '#price'), /≤ 0\.\d/);
    const ratios = await page.evaluate(
        "[...document.querySelectorAll('#price table:last-child td:last-child')].map((each) => each.innerText.trim())",
    );
    assert.ok(ratios.includes('–'), ratios.join('; ')); // a figure that is null
    assert.doesNotMatch(await text(page, 'main'), /NaN|undefined|null|Infinity/);
}

async function listsWhatFailed(page) {
    assert.match(await text(page, '#failed'), /width 0 px at pixel \(12, 7\) <\/script>/);
}

async function putsBudgetsBesideErrors(page) {
    assert.match(await text(page, '#budget'), /Over it: frame 1/);
    const lines = await page.evaluate(
        "document.querySelectorAll('#budget svg [aria-label=line] path').length",
    );
    assert.equal(lines, 2); // measured, allowed
    await choose(page, 'budget', 'flicker');
    assert.match(await text(page, '#budget .axis-title'), /still camera/);
}

async function namesTheCommand(page) {
    assert.equal(await text(page, 'h1'), 'Replay of desk');
}

async function saysThatItIsAPicture(page) {
    assert.equal(await text(page, 'h1'), 'Picture of the view of desk');
    assert.doesNotMatch(await text(page, 'body'), /replay/i);
}

async function showsTheOtherWork(page) {
    await page.evaluate("document.querySelector('input[value=room]').click()");
    await page.settle();
    assert.equal(await text(page, '.work-title'), 'Room & <b>window</b>');
    assert.equal(await page.evaluate("document.querySelector('#blame')"), null); // it has no truth
    assert.doesNotMatch(await text(page, 'main'), /NaN|undefined|null|Infinity/);
}

/** A page of which most figures are missing. */
async function showsWhatThereIs(page) {
    const shown = await text(page, 'main');
    assert.match(shown, /–/);
    assert.doesNotMatch(shown, /NaN|undefined|null|Infinity/);
}

async function drawsEveryFrame(page) {
    assert.equal(
        await page.evaluate(
            "document.querySelectorAll('#stages svg [aria-label=rect] rect').length",
        ),
        60 * 7,
    ); // frames, stages
    assert.equal(
        await page.evaluate(
            "document.querySelectorAll('#tracking svg [aria-label=rect] rect').length",
        ),
        60,
    );
}

async function givesThePlan(page) {
    const plan = await text(page, '#plan');
    assert.match(plan, /environment direct\s+yes/);
    assert.match(plan, /hair\s+no\s+no object has strands/);
}

const bench = [
    common.pointerMovesTheSlider,
    common.keysMoveTheSlider,
    common.clickMovesTheInset,
    common.differenceIsOfThePair,
];
const always = [
    common.fitsAPhone,
    common.themesApply,
    common.dataStaysText,
    common.nothingIsLoaded,
    common.nothingIsWrong,
];
const checks = {
    accuracy: [
        common.chartsAreDrawn,
        drawsALinePerMethod,
        namesTheFront,
        followsTheChoice,
        showsBoundsAndDashes,
        listsWhatFailed,
        putsBudgetsBesideErrors,
        ...bench,
        common.fitsAPhone,
        showsTheOtherWork,
        ...always,
    ],
    replay: [common.chartsAreDrawn, drawsEveryFrame, givesThePlan, namesTheCommand, ...bench, ...always],
    render: [saysThatItIsAPicture, common.nothingIsWrong],
    sparse: [showsWhatThereIs, common.fitsAPhone, common.nothingIsWrong],
    refusal: [
        async function saysWhyItShowsNothing(page) {
            assert.match(await text(page, '#page'), /version 2, this page reads version 1/);
        },
    ],
};
const charts = { accuracy: 6, replay: 4 };

async function checkPage(browser, kind, file) {
    const url = pathToFileURL(file).href;
    const page = await browser.openPage();
    await page.size(1280, 900);
    await page.open(url);
    if (kind in charts)
        await page.evaluate(
            `new Promise((done) => {
                const look = () => document.querySelector('.inset canvas') ? done(true) : setTimeout(look, 20);
                look();
            })`,
        );
    await page.settle();
    let failures = 0;
    for (const check of checks[kind]) {
        try {
            await check(page, { charts: charts[kind], url });
            console.log(`ok      ${kind}: ${check.name}`);
        } catch (error) {
            ++failures;
            console.log(`FAILED  ${kind}: ${check.name}: ${error.message}`);
        }
    }
    return failures;
}

const browser = await startBrowser();
let failures = 0;
try {
    for (let i = 2; i + 1 < process.argv.length; i += 2)
        failures += await checkPage(browser, process.argv[i], process.argv[i + 1]);
} finally {
    await browser.close();
}
process.exitCode = failures > 0 ? 1 : 0;
