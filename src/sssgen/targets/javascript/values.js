// The properties of a material: its tables, and checks of the values that users set.

/**
 * A parameter in the table `parameters` of a material.
 * @typedef {object} Parameter
 * @property {string} type the type in GLSL
 * @property {number | boolean | number[]} default
 * @property {boolean} [color] whether it is a colour, in linear light
 * @property {number[]} [range] the lowest and the highest value
 * @property {string} [unit]
 * @property {boolean} [placed] whether it is a value of the body before the object places it
 * @property {string} name the name in the shader
 */

/**
 * A texture in the table `textures` of a material.
 * @typedef {object} TextureParameter
 * @property {string} type sampler2D, sampler3D, samplerCube or sampler2DArray
 * @property {string} default the texel that is read where there is no texture: a key of TEXELS
 * @property {string} [colorSpace] the colour space of its texels
 * @property {boolean} [color] whether it has colours, in sRGB
 * @property {string} [needed] what to do for it, where a picture without it is wrong
 * @property {string} name the name in the shader
 */

/** The number that a material's module has as `version`: the version of the data that this file reads. */
const VERSION = 1;

/** The texel of a texture that is not set. */
export const TEXELS = { white: [1, 1, 1, 1], black: [0, 0, 0, 1], gray: [0.5, 0.5, 0.5, 1], bump: [0.5, 0.5, 1, 1] };

/** Values of a light that an unlit material may read. */
const LIGHT_INPUTS = ['L', 'L_object', 'light_color', 'light_nearness'];

/** A value as an error shows it. */
function shown(value) {
  if (typeof value === 'string') return `'${value}'`;
  return Array.isArray(value) ? `[${value.join(', ')}]` : (typeof value === 'object' && value?.constructor?.name) || String(value);
}

/** The properties that a material adds to the engine's class. */
export class Properties {
  /** The textures with a warning. */
  #warned = new Set();

  /**
   * @param {object} material as its module describes it
   * @param {string} material.name
   * @param {number} material.version
   * @param {boolean} [material.lit]
   * @param {string[]} material.inputs
   * @param {Record<string, Parameter>} material.parameters
   * @param {Record<string, TextureParameter>} material.textures
   * @param {string} engineClass the name of the engine's class
   */
  constructor({ name, version, lit, inputs, parameters, textures }, engineClass) {
    if (version !== VERSION) throw new Error(`${name} was written by another version of sssgen than its runtime: emit it again`);
    this.material = name;
    this.parameters = parameters;
    this.textures = textures;
    this.names = [...Object.keys(parameters), ...Object.keys(textures)];
    this.engineClass = engineClass;
    /** Whether the material has the property `time`. */
    this.moves = inputs.includes('time');
    /** Whether it has the property `light`: it is unlit, and reads a light. */
    this.takesLight = !lit && LIGHT_INPUTS.some((input) => inputs.includes(input));
  }

  /** A number that is different for different texts. */
  static hashOf(text) {
    return [...text].reduce((hash, letter) => (hash * 31 + letter.charCodeAt(0)) >>> 0, 7);
  }

  /** Defines a property with its accessors, and its name in older modules (`metalness_` for `sssMetalness`). */
  define(prototype, name, accessors) {
    Object.defineProperty(prototype, name, accessors);
    const older = name.replace(/^sss([A-Z])(.*)/, (_, first, others) => `${first.toLowerCase()}${others}_`);
    if (older !== name) Object.defineProperty(prototype, older, accessors);
  }

  /** Throws an error about a value that a property does not take. */
  refuse(name, taken, value) {
    throw new TypeError(`${this.material}: '${name}' takes ${taken}, not ${shown(value)}`);
  }

  /** Throws an error if there is a name that the object does not have. */
  checkNames(object, values) {
    const unknown = Object.keys(values ?? {}).filter((name) => !(name in object));
    if (!unknown.length) return;
    const own = this.names.join(', ') || 'none';
    throw new TypeError(`${this.material} has no property ${unknown.map(shown).join(', ')}. Its own: ${own}; the others are those of ${this.engineClass}`);
  }

  /** Throws an error about a texture of another kind than the shader reads. */
  checkKind(name, { cube, volume, layers }) {
    const read = this.textures[name].type.replace('sampler', '');
    const given = cube ? 'Cube' : volume ? '3D' : layers ? '2DArray' : '2D';
    if (read !== given) throw new TypeError(`${this.material}: '${name}' takes a ${read} texture, not a ${given} texture`);
  }

  /**
   * Warns when a body is drawn, once for each texture: of one that is missing, and of a transform that has no effect.
   * @param {(name: string) => any} given the texture that the page has set
   * @param {(texture: any) => boolean} isTransformed whether the engine would transform coordinates for it
   * @param {{ has: (name: string) => boolean }} sources those that a pass computes from what the page has set
   */
  checkTextures(given, isTransformed = () => false, sources = new Set()) {
    for (const [name, { needed }] of Object.entries(this.textures)) {
      const texture = given(name);
      if (needed && !texture && !sources.has(name)) this.#warn(name, `is missing: ${needed}`);
      if (texture && isTransformed(texture)) this.#warn(name, 'has a transform, which has no effect: the technique uv_transform moves texture coordinates');
    }
  }

  #warn(name, text) {
    if (this.#warned.has(name)) return;
    this.#warned.add(name);
    console.warn(`${this.material}: '${name}' ${text}`);
  }

  /**
   * The numbers of a parameter's value: a number, an array, a vector, a colour or a matrix; undefined: its default.
   * `colors` says in an error which colours it takes, too.
   */
  numbers(name, value, colors = '') {
    const { type, default: start } = this.parameters[name];
    const count = Array.isArray(start) ? start.length : 1;
    const given = value === undefined ? start : value;
    const listed = typeof given === 'object' && given ? Array.from(given.asArray?.() ?? given.toArray?.() ?? given.data ?? given) : [given];
    const fits = listed.length === count && listed.every((one) => typeof one === 'boolean' || Number.isFinite(one));
    if (!fits) this.refuse(name, (count > 1 ? `${count} numbers` : type === 'bool' ? 'true or false' : 'a number') + colors, value);
    return listed.map(Number);
  }
}
