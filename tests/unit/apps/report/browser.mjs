// The installed Chromium without a window, driven through its debugging pipe.
import { spawn } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { delimiter, join } from 'node:path';

function chromiumPath() {
    const folders = ['/usr/bin', ...(process.env.PATH ?? '').split(delimiter)];
    const found = folders
        .flatMap((folder) => ['chromium', 'chromium-browser'].map((name) => join(folder, name)))
        .find(existsSync);
    if (!found)
        throw new Error(
            'no Chromium is installed: install the package chromium (./run build does)',
        );
    return found;
}

/** Messages over the pipe: `send(method, params, session)` gives a promise of the result. */
function connection(process_) {
    const pending = new Map(),
        listeners = [];
    let count = 0,
        rest = Buffer.alloc(0);
    const receive = (message) => {
        if (!message.id) return listeners.forEach((listener) => listener(message));
        const { resolve, reject } = pending.get(message.id);
        pending.delete(message.id);
        return message.error ? reject(new Error(message.error.message)) : resolve(message.result);
    };
    process_.stdio[4].on('data', (data) => {
        rest = Buffer.concat([rest, data]);
        for (let end = rest.indexOf(0); end >= 0; end = rest.indexOf(0)) {
            const text = rest.subarray(0, end).toString('utf8');
            rest = rest.subarray(end + 1);
            receive(JSON.parse(text));
        }
    });
    process_.on('exit', () => pending.forEach(({ reject }) => reject(new Error('Chromium ended'))));
    return {
        listen: (listener) => listeners.push(listener),
        send: (method, params = {}, sessionId = undefined) =>
            new Promise((resolve, reject) => {
                pending.set(++count, { resolve, reject });
                process_.stdio[3].write(
                    `${JSON.stringify({ id: count, method, params, sessionId })}\0`,
                );
            }),
    };
}

const patience = 3000; // ms, until Chromium is ended by force

/** Starts Chromium: `openPage()` gives a page, `close()` ends it and removes its profile. */
export async function startBrowser() {
    const chromium = chromiumPath();
    const profile = mkdtempSync(join(tmpdir(), 'inlay-chromium-'));
    const process_ = spawn(
        chromium,
        [
            '--headless=new',
            '--no-sandbox',
            '--disable-gpu',
            '--disable-dev-shm-usage',
            '--no-first-run',
            '--disable-background-networking',
            '--hide-scrollbars',
            `--user-data-dir=${profile}`,
            '--remote-debugging-pipe',
            'about:blank',
        ],
        { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'], detached: true },
    );
    const link = connection(process_);
    const ended = new Promise((resolve) => process_.on('exit', resolve));
    return {
        async openPage() {
            const { targetId } = await link.send('Target.createTarget', { url: 'about:blank' });
            const { sessionId } = await link.send('Target.attachToTarget', {
                targetId,
                flatten: true,
            });
            return page(link, sessionId);
        },
        async close() {
            link.send('Browser.close').catch(() => {});
            await Promise.race([
                ended,
                new Promise((resolve) => setTimeout(resolve, patience).unref()),
            ]);
            try {
                process.kill(-process_.pid, 'SIGKILL'); // with all its children
            } catch {
                // it has ended by itself
            }
            await ended;
            rmSync(profile, { recursive: true, force: true, maxRetries: 5 });
        },
    };
}

/** Keeps what the page asks for and complains about: `{requests, problems, onload}`. */
function observe(link, sessionId) {
    const seen = { requests: [], problems: [], onload: () => {} };
    const reactions = {
        'Network.requestWillBeSent': ({ request }) => seen.requests.push(request.url),
        'Runtime.exceptionThrown': ({ exceptionDetails: { exception, text } }) =>
            seen.problems.push(exception?.description ?? text),
        'Runtime.consoleAPICalled': ({ type, args }) => {
            if (!['error', 'warning', 'assert'].includes(type)) return;
            seen.problems.push(args.map((each) => each.value ?? each.description).join(' '));
        },
        'Log.entryAdded': ({ entry }) => {
            if (entry.level !== 'info') seen.problems.push(entry.text);
        },
        'Page.loadEventFired': () => seen.onload(),
    };
    link.listen(({ sessionId: from, method, params }) => {
        if (from === sessionId) reactions[method]?.(params);
    });
    return seen;
}

const twoFrames =
    'new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))';

/** What a reader does and how the page is shown; `send(method, params)`. */
const gestures = (send) => ({
    size: (width, height) => {
        const device = { width, height, deviceScaleFactor: 1, mobile: width < 500 };
        return send('Emulation.setDeviceMetricsOverride', device);
    },
    scheme: (value) => {
        const features = [{ name: 'prefers-color-scheme', value }];
        return send('Emulation.setEmulatedMedia', { features });
    },
    mouse: (type, x, y, pressed) => {
        const button = pressed || type === 'mouseReleased' ? 'left' : 'none';
        const buttons = pressed ? 1 : 0;
        return send('Input.dispatchMouseEvent', { type, x, y, button, buttons, clickCount: 1 });
    },
    async key(key) {
        await send('Input.dispatchKeyEvent', { type: 'keyDown', key, code: key });
        await send('Input.dispatchKeyEvent', { type: 'keyUp', key, code: key });
    },
});

async function page(link, sessionId) {
    const send = (method, params) => link.send(method, params, sessionId);
    const seen = observe(link, sessionId);
    for (const domain of ['Page', 'Runtime', 'Network', 'Log']) await send(`${domain}.enable`);
    await send('Page.bringToFront'); // pages behind others paint nothing
    const evaluate = async (expression) => {
        const call = { expression, awaitPromise: true, returnByValue: true };
        const { result, exceptionDetails } = await send('Runtime.evaluate', call);
        if (!exceptionDetails) return result.value;
        throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    };
    return {
        ...gestures(send),
        requests: seen.requests,
        problems: seen.problems,
        evaluate,
        /** Two frames have been painted since all earlier changes. */
        settle: () => evaluate(twoFrames),
        async open(url) {
            const ready = new Promise((resolve) => (seen.onload = resolve));
            await send('Page.navigate', { url });
            await ready;
        },
        /** A PNG in base64 of `{x, y, width, height}` in CSS px of the page. */
        async screenshot(clip) {
            const part = { clip: { ...clip, scale: 1 }, captureBeyondViewport: true };
            return (await send('Page.captureScreenshot', part)).data;
        },
    };
}
