// What must hold for every report page.
import assert from 'node:assert/strict';

const handle = "document.querySelector('.comparison .handle')";
const sliderValue = (page) => page.evaluate(`Number(${handle}.getAttribute('aria-valuenow'))`);

async function box(page, selector) {
    await page.evaluate(
        `document.querySelector('${selector}').scrollIntoView({ block: 'center', behavior: 'instant' })`,
    );
    await page.settle();
    return page.evaluate(
        `(({ x, y, width, height }) => ({ x, y, width, height }))(document.querySelector('${selector}').getBoundingClientRect())`,
    );
}

/** The comparison as it is seen, but for the handle. */
async function comparison(page) {
    const { x, y, width, height } = await box(page, '.comparison');
    const top = await page.evaluate('scrollY');
    await page.evaluate(`${handle}.style.opacity = 0`);
    const picture = await page.screenshot({ x, y: y + top, width, height });
    await page.evaluate(`${handle}.style.opacity = ''`);
    return picture;
}

/** In every chart the marks of data, which axes and grids are not. */
const marksOfCharts = `[...document.querySelectorAll('.chart')].map((chart) =>
  ['line', 'dot', 'bar', 'rect'].reduce((sum, mark) =>
    sum + chart.querySelectorAll('svg [aria-label=' + mark + '] > *').length, 0))`;

export async function chartsAreDrawn(page, { charts }) {
    const marks = await page.evaluate(marksOfCharts);
    assert.equal(marks.length, charts);
    // The smallest chart of the samples has a mark for each of 8 frames.
    for (const count of marks) assert.ok(count >= 8, `charts have ${marks} marks`);
}

export async function pointerMovesTheSlider(page) {
    const before = await comparison(page);
    const { x, y, width, height } = await box(page, '.comparison .handle');
    const grip = [x + width / 2, y + height / 2];
    await page.mouse('mousePressed', ...grip, true);
    await page.mouse('mouseMoved', grip[0] - 60, grip[1], true);
    await page.mouse('mouseReleased', grip[0] - 60, grip[1], false);
    const value = await sliderValue(page);
    assert.ok(value < 50, `the slider stands at ${value}`);
    assert.notEqual(await comparison(page), before, 'the picture is as before');
}

export async function keysMoveTheSlider(page) {
    await page.evaluate(`${handle}.focus()`);
    await page.key('Home');
    assert.equal(await sliderValue(page), 0);
    const right = await comparison(page);
    await page.key('ArrowRight');
    assert.equal(await sliderValue(page), 1);
    await page.key('PageUp');
    assert.equal(await sliderValue(page), 11);
    await page.key('End');
    assert.equal(await sliderValue(page), 100);
    assert.notEqual(await comparison(page), right, 'both ends show the same picture');
}

export async function clickMovesTheInset(page) {
    const caption = "document.querySelector('.inset figcaption').textContent";
    const { x, y, width, height } = await box(page, '.comparison');
    await page.mouse('mousePressed', x + width * 0.25, y + height * 0.75, true);
    await page.mouse('mouseReleased', x + width * 0.25, y + height * 0.75, false);
    assert.match(await page.evaluate(caption), /at \(40, 90\)$/); // of 160 x 120 px
}

const canvasColours = `(() => {
  const copy = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
  copy.drawImage(document.querySelector('.difference canvas'), 0, 0);
  return new Set(new Uint32Array(copy.getImageData(0, 0, 160, 120).data.buffer));
})()`; // of the whole picture

export async function differenceIsOfThePair(page) {
    assert.ok((await page.evaluate(`${canvasColours}.size`)) > 10, 'two pictures do not differ');
    await page.evaluate(`(() => {
    const [, left, right] = document.querySelectorAll('#pictures select');
    right.value = left.value;
    right.dispatchEvent(new Event('change'));
  })()`);
    await page.evaluate(`new Promise((done) => {
    const wait = () => (${canvasColours}.size === 1 ? done(true) : setTimeout(wait, 20));
    wait();
  })`); // a picture less itself is of one colour
}

/** At the width of a phone, with all that can be unfolded unfolded. */
export async function fitsAPhone(page) {
    await page.size(390, 844);
    await page.evaluate(
        "document.querySelectorAll('details').forEach((each) => (each.open = true))",
    );
    await page.settle();
    assert.equal(await page.evaluate('document.documentElement.scrollWidth'), 390);
    await page.size(1280, 900);
    await page.settle();
}

const colours = `(() => {
  const light = (colour) => colour.match(/[\\d.]+/g).slice(0, 3).reduce((sum, each) => sum + Number(each), 0) / 765;
  const body = getComputedStyle(document.body);
  const mark = document.querySelector('.chart svg [fill^="var(--series"], .chart svg [stroke^="var(--series"]');
  return { ground: light(body.backgroundColor), text: light(body.color), mark: getComputedStyle(mark).fill + getComputedStyle(mark).stroke };
})()`;

export async function themesApply(page) {
    await page.scheme('light');
    const light = await page.evaluate(colours);
    await page.scheme('dark');
    await page.settle();
    const dark = await page.evaluate(colours);
    // Text and ground keep apart by more than half of the range of brightness in both themes.
    assert.ok(light.ground - light.text > 0.5, JSON.stringify(light));
    assert.ok(dark.text - dark.ground > 0.5, JSON.stringify(dark));
    assert.notEqual(dark.mark, light.mark, 'the charts keep their colours');
    await page.evaluate("document.querySelector('.theme-toggle').click()");
    assert.deepEqual(await page.evaluate(colours), light);
    await page.scheme('light');
}

/** Of all that was asked for, only the page itself came from outside the page. */
export async function nothingIsLoaded(page, { url }) {
    assert.deepEqual(
        page.requests.filter((each) => !each.startsWith('data:')),
        [url],
    );
}

export async function nothingIsWrong(page) {
    assert.deepEqual(page.problems, []);
}

/** No text of the data became an element. */
export async function dataStaysText(page) {
    assert.equal(await page.evaluate("document.querySelectorAll('main b, header b').length"), 0);
}
