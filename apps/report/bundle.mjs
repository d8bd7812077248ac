// Makes one HTML page of src/, and a C++ source that holds it, cut where the data goes.
// usage: node bundle.mjs MODULES OUT     MODULES: the node_modules folder; OUT: the folder for the results
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';

const source = join(dirname(fileURLToPath(import.meta.url)), 'src');
const [modules, out] = process.argv.slice(2).map((path) => resolve(path));

function bundle(esbuild, entry) {
    return esbuild.buildSync({
        entryPoints: [join(source, entry)],
        bundle: true,
        minify: true,
        write: false,
        metafile: true,
        charset: 'utf8',
        format: 'iife',
        target: ['es2022'],
        nodePaths: [modules],
        legalComments: 'none',
    });
}

/** The licence texts of the packages that are in a bundle, each text once, under the names that share it. */
function licences(metafile) {
    const folders = new Set(
        Object.keys(metafile.inputs)
            .map((path) => /^.*node_modules\/(?:@[^/]+\/)?[^/]+/.exec(path)?.[0])
            .filter(Boolean),
    );
    const byText = new Map();
    for (const folder of [...folders].sort()) {
        const { name, version } = JSON.parse(readFileSync(join(folder, 'package.json'), 'utf8'));
        const file = readdirSync(folder).find((each) => /^licen[cs]e/i.test(each));
        if (!file)
            throw new Error(
                `the package ${name} has no licence file, so it cannot be part of the page`,
            );
        const text = readFileSync(join(folder, file), 'utf8').trim();
        byText.set(text, [...(byText.get(text) ?? []), `${name} ${version}`]);
    }
    return [...byText].map(([text, names]) => `${names.join(', ')}\n\n${text}`).join('\n\n\n');
}

const escaped = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;');

function template() {
    const esbuild = createRequire(join(modules, 'modules.cjs'))('esbuild');
    const script = bundle(esbuild, 'main.js'),
        styles = bundle(esbuild, 'styles/main.css');
    return readFileSync(join(source, 'page.html'), 'utf8')
        .replace('/*styles*/', () => styles.outputFiles[0].text.trim())
        .replace('/*script*/', () => script.outputFiles[0].text.trim())
        .replace('<!--licences-->', () => escaped(licences(script.metafile)));
}

function asSource(page) {
    const parts = page.split('/*data*/');
    if (parts.length !== 2) throw new Error('src/page.html must have one place for the data');
    if (page.includes(')inlay"')) throw new Error('the page holds the end mark of its C++ string');
    const [head, tail] = parts.map((part) => `R"inlay(${part})inlay"`);
    return (
        '// The report page before and after its data.\n#include "apps/report/report_template.h"\n\nnamespace inlay {\n\n' +
        `const std::string_view report_head = ${head};\n\nconst std::string_view report_tail = ${tail};\n\n}  // namespace inlay\n`
    );
}

mkdirSync(out, { recursive: true });
const page = template();
writeFileSync(join(out, 'report_template.html'), page);
writeFileSync(join(out, 'report_template.cpp'), asSource(page));
