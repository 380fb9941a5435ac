// Draws Vega-Lite specifications as SVG, without a browser.
//
//   node docs/figures/render.mjs SPEC.vl.json OUT.svg [SPEC OUT]...     SPEC may be - for standard input
//
// Each SVG names the specification that it was made from by its SHA-256, so that a test can tell whether a figure is that of today
// without drawing it. `npm ci` in the top folder installs what this needs.
import {createHash} from 'node:crypto';
import {readFileSync, writeFileSync} from 'node:fs';
import * as vega from 'vega';
import * as vegaLite from 'vega-lite';

// Without a canvas Vega reckons with 0.8 of the font size per character and gives away a third of the width.
vega.textMetrics.width = (item, text) => 0.6 * item.fontSize * String(text ?? '').length;

async function draw(text) {
  const spec = vegaLite.compile(JSON.parse(text)).spec;
  const view = new vega.View(vega.parse(spec), {renderer: 'none'});
  const svg = await view.toSVG();
  view.finalize();
  const made = createHash('sha256').update(text).digest('hex');
  return `${svg}\n<!-- specification ${made} -->\n`;
}

const files = process.argv.slice(2);
if (files.length === 0 || files.length % 2 !== 0) {
  console.error('usage: node docs/figures/render.mjs SPEC.vl.json OUT.svg [SPEC OUT]... (SPEC - is standard input)');
  process.exit(2);
}
for (let i = 0; i < files.length; i += 2) {
  const text = readFileSync(files[i] === '-' ? 0 : files[i], 'utf8');
  writeFileSync(files[i + 1], await draw(text));
}
