// Assembles the page as the program does: template, style, scripts in the order of order.txt, data with its markup escaped.
// Knows the folder's layout; knows nothing of what the data says.
import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const folder = fileURLToPath(new URL('..', import.meta.url));
const text = name => readFileSync(folder + name, 'utf8');

/** The files of the script, in order. */
export const order = () =>
  text('order.txt')
    .split('\n')
    .filter(line => line !== '');

/** JSON that cannot end the script element it stands in. */
export const embed = data =>
  JSON.stringify(data).replace(/[<>&\u2028\u2029]/g, c => '\\u' + c.charCodeAt(0).toString(16).padStart(4, '0'));

/** How the sentence begins that a page shows where its script may not run. */
export const SENTENCE = 'This page needs scripts for its figures';

const escaped = text => text.replace(/[<>&"']/g, c => `&#${c.charCodeAt(0)};`);

/** The whole page of one data object. The template is cut at its places once, so that no text is searched for places again. */
export function build(data) {
  const still = `<main id="main"><h1>${escaped(data.study.name)}</h1><p class="note">${SENTENCE}</p><p>${escaped(
    (data.cards ?? []).map(card => `${card.label} ${card.value}`).join('; '),
  )}</p></main>`;
  const parts = { still, style: text('style.css'), script: order().map(text).join('\n'), data: embed(data) };
  return text('page.html')
    .split(/\{\{(style|still|script|data)\}\}/)
    .map((piece, at) => (at % 2 ? parts[piece] : piece))
    .join('');
}
