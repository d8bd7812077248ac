// usage: node write_sample.mjs accuracy|replay|render FILE
import { writeFileSync } from 'node:fs';
import { sampleAccuracy } from './sample_accuracy.mjs';
import { sampleRender, sampleReplay } from './sample_replay.mjs';

const [kind, file] = process.argv.slice(2);
writeFileSync(file, JSON.stringify({ accuracy: sampleAccuracy, replay: sampleReplay, render: sampleRender }[kind]()));
