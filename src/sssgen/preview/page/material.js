// The material of a picture: made of the emitted module, and kept while only values change.

/** @typedef {import('three').Material & { envMap: import('three').Texture | null } & Record<string, any>} EmittedMaterial
 *   A property for each parameter and each texture. */
/** @typedef {import('../page_messages.js').BodyPicture} BodyPicture */
/** @typedef {Record<string, import('three').Texture>} Textures  Property → texture. */

const made = (/** @type {string} */ text) => {
  const url = URL.createObjectURL(new Blob([text], { type: 'text/javascript' }));
  return import(url).finally(() => URL.revokeObjectURL(url));
};

/** The numbers of a control as the material takes them.
 * @param {import('../page_messages.js').Control} control @param {number[]} numbers */
export function valueOf(control, numbers) {
  if (control.type === 'bool') return numbers[0] !== 0;
  return numbers.length > 1 ? numbers : numbers[0];
}

/** What must stay the same for a material to be kept: the module without comments and the lines of the parameters' defaults.
 * @param {BodyPicture} picture */
export function programOf({ module, controls, textures, two_sided }) {
  const names = new Set(controls.map((control) => control.property));
  const own = (/** @type {string} */ line) => /^\s*\/\//.test(line) || names.has(/^\s+(\w+): \{ type: '/.exec(line)?.[1] ?? '');
  const lines = module.split('\n').filter((line) => !own(line));
  const slots = textures.map((row) => [row.property, row.drawn, row.texels?.dim]);
  return JSON.stringify([lines, controls.map((control) => [control.property, control.type]), slots, two_sided]);
}

/** A new material.
 * @param {BodyPicture} picture @param {import('../page_messages.js').Values} values @param {Textures} textures
 * @returns {Promise<EmittedMaterial>} */
export async function materialOf(picture, values, textures) {
  const { createMaterial } = await made(picture.module);
  return createMaterial({ ...numbersOf(picture, values), ...textures });
}

/** Gives a material the values and textures of a picture of the same program.
 * @param {EmittedMaterial} material @param {BodyPicture} picture @param {import('../page_messages.js').Values} values @param {Textures} textures */
export function update(material, picture, values, textures) {
  for (const [property, value] of Object.entries(numbersOf(picture, values))) material[property] = value;
  for (const [property, texture] of Object.entries(textures)) if (material[property] !== texture) material[property] = texture;
}

/** @param {BodyPicture} picture @param {import('../page_messages.js').Values} values */
function numbersOf(picture, values) {
  return Object.fromEntries(picture.controls.filter((control) => !control.drawn)
    .map((control) => [control.property, valueOf(control, values.get(control.property) ?? control.value)]));
}
