// The colours of TOML, of techniques and of emitted text: by words, no language is parsed.

const TOML = /(?<comment>#[^\n]*)|(?<string>"(?:[^"\\\n]|\\.)*"|'[^'\n]*')|(?<head>^\s*\[\[?[^\]\n]*\]\]?)|(?<number>[-+]?\b\d[\d_]*(?:\.\d+)?(?:e[-+]?\d+)?\b)|(?<word>\b(?:true|false)\b|^[ \t]*[\w.-]+(?=\s*=))/gmi;
const CODE = new RegExp([
  String.raw`(?<comment>\/\/[^\n]*|\/\*[\s\S]*?(?:\*\/|$))`,
  String.raw`(?<string>"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*')`,
  String.raw`(?<head>^[ \t]*[#@]\w*)`,
  String.raw`(?<number>\b(?:0x[\da-f]+|\d+\.?\d*(?:e[-+]?\d+)?|\.\d+)[fuh]?\b)`,
  String.raw`(?<word>\b(?:const|in|out|inout|uniform|struct|return|if|else|for|while|do|switch|case|default|break|continue|discard|let|var|fn|def|import|from|export|function|class|void|precision|highp|layout|static|inline|true|false)\b)`,
  String.raw`(?<type>\b(?:float|int|uint|bool|half|[iub]?vec[234][fhui]?|mat[234](?:x[234])?f?|float[234](?:x[234])?|half[234]|sampler\w*|texture_\w+|f32|i32|u32|f16|world_(?:direction|position)|thickness|transmittance|normal|tangent_direction)\b)`,
].join('|'), 'gm');

/** @type {Record<string, string>} */
const ENTITIES = { '&': '&amp;', '<': '&lt;', '>': '&gt;' };
const escaped = (/** @type {string} */ text) => text.replace(/[&<>]/g, (letter) => ENTITIES[letter]);

/** A text as HTML. `name` is its file's; `faults` are places from and to, in characters.
 * @param {string} text @param {string} name @param {number[][]} faults */
export function colored(text, name, faults = []) {
  const marks = [];
  const pattern = /\.(toml|json)$/.test(name) ? TOML : CODE;
  for (const match of text.matchAll(pattern)) {
    const kind = Object.entries(match.groups ?? {}).find(([, part]) => part !== undefined)?.[0];
    marks.push([match.index, match.index + match[0].length, kind]);
  }
  const cuts = new Set([0, text.length, ...marks.flatMap(([from, to]) => [from, to]), ...faults.flat()]);
  const order = [...cuts].filter((cut) => cut >= 0 && cut <= text.length).sort((a, b) => a - b);
  let html = '';
  let mark = 0;
  for (let index = 0; index + 1 < order.length; index++) {
    const [from, to] = [order[index], order[index + 1]];
    while (mark < marks.length && marks[mark][1] <= from) mark++;
    const kinds = [];
    if (mark < marks.length && marks[mark][0] <= from) kinds.push(marks[mark][2]);
    if (faults.some(([start, end]) => start <= from && to <= end)) kinds.push('fault');
    const part = escaped(text.slice(from, to));
    html += kinds.length ? `<span class="${kinds.join(' ')}">${part}</span>` : part;
  }
  return html;
}
