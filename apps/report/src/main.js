// Reads the data of the page and hands it to the page of its kind.
import { accuracyPage } from './accuracy_page.js';
import { h } from './dom.js';
import { replayPage } from './replay_page.js';
import { followTheme } from './theme.js';

const pages = { accuracy: accuracyPage, replay: replayPage };
const knownVersion = 1;

function pageOf(text) {
    const report = JSON.parse(text);
    if (report.version !== knownVersion) {
        throw new Error(
            `the data is of version ${report.version}, this page reads version ${knownVersion}`,
        );
    }
    const page = pages[report.kind ?? 'accuracy'];
    if (!page)
        throw new Error(`the data is of the kind "${report.kind}", which this page does not know`);
    return page(report);
}

followTheme();
const root = document.getElementById('page');
try {
    root.replaceChildren(...pageOf(document.getElementById('data').textContent));
} catch (error) {
    root.replaceChildren(
        h(
            'p',
            { class: 'refusal', role: 'alert' },
            `This report cannot be shown: ${error.message}.`,
        ),
    );
    throw error;
}
