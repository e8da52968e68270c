// The passes of a material, as every engine draws them: pictures of the body alone, as the eye or a light sees it.

/**
 * A pass, as a material's module lists it.
 * @typedef {object} Pass
 * @property {string} name
 * @property {string} seenFrom `eye`, `light`, `distant light`, `each light`, or `inside` for a volume of the light in the body
 * @property {string[]} layers for each channel `entry N` or `exit N`: the N-th front or back face, or `light`: what a white
 *   matt surface there reflects; [] for the scene without the body
 * @property {'0' | 'far'} empty what a texel without a surface has
 * @property {string} texture the property of the picture
 * @property {string[]} views the properties of the matrices from world space to the picture, one for each light
 * @property {string | null} [size] the property of the last level of a picture with levels
 */

/** The distance beside a body in a picture of light: more than any of a body's. It fits into half a float. */
export const FAR = 60000;
/** The width of what one light sees, in texels. */
export const SIDE = 1024;
/** The least distance between two layers, in radii of the body. */
export const LAYER_GAP = 1e-3;

/** The names of layers in the shader that writes them into one picture. */
export const LAYERS = ['sss_layer0', 'sss_layer1', 'sss_layer2', 'sss_layer3'];

/** That shader: in GLSL the whole, in WGSL what it writes. `parts`: what it takes of each layer. */
export function packing(parts) {
  const declared = LAYERS.map((name) => `uniform highp sampler2D ${name};`).join('\n');
  const glsl = parts.map((part, index) => `texelFetch(${LAYERS[index]}, ivec2(gl_FragCoord.xy), 0).${part}`).join(', ');
  const wgsl = parts.map((part, index) => `textureLoad(${LAYERS[index]}, at, 0).${part}`).join(', ');
  return { glsl: `\n${declared}\nvoid main() {\n  gl_FragColor = vec4(${glsl});\n}`, wgsl: `vec4f(${wgsl})` };
}

/** Of four distances. */
export const PACKING = packing(['r', 'r', 'r', 'r']);

/**
 * What a texel without a surface has. `end` is the largest distance in what lights see: a larger one would spread where a filter
 * blends texels.
 */
export const emptyOf = ({ empty, seenFrom }, end = FAR) => (empty !== 'far' ? 0 : seenFrom === 'eye' ? FAR : end);

/** Whether a pass shows the light on the body, and not only distances. */
export const showsLight = ({ layers }) => layers.includes('light');

/** Whether it is a volume, which is not drawn, but computed. */
export const isVolume = ({ seenFrom }) => seenFrom === 'inside';

/** Whether filters blend the texels of its picture. */
export const isFiltered = (pass) => pass.seenFrom !== 'eye' || showsLight(pass);

/**
 * An area of light, where runtimes know its sides: the names of two functions of the texts.
 * @typedef {object} Area
 * @property {string} towards the way to one of four points of it
 * @property {string} light what comes from there
 */

/**
 * How far the points are from the centre, in halves of the sides: so that the sum over a rectangle is exact for cubic
 * functions. Where a chain finds the view of a light by the way to it, they are all at the centre.
 * @param {Pass[] | undefined} passes
 */
export const spreadOf = (passes, spread = '0.57735027') => (passes?.some(({ seenFrom }) => seenFrom === 'each light') ? '0.0' : spread);

/** How many tiles a picture has, across and up: no more than its lights need. */
export const tilesOf = (lights) => ({ across: lights > 1 ? 2 : 1, up: lights > 2 ? 2 : 1 });

/** The tile of a light. */
export const tileOf = (light) => ({ x: light % 2, y: Math.floor(light / 2) });

/**
 * The layers of a pass: whether one has back faces, and the number of the layer that its surfaces are behind; -1 for none.
 * @param {Pass} pass
 */
export function layersOf({ layers }) {
  return layers.map((layer) => {
    const [side, count] = layer.split(' ');
    const back = side === 'exit';
    return { back, before: Number(count) > 1 ? layers.indexOf(back ? `entry ${count}` : `exit ${Number(count) - 1}`) : -1 };
  });
}

/**
 * Those of some lights that a pass shows, the brightest at the body first. From afar: directional lights, if there are any.
 * @template Light
 * @param {{ light: Light, strength: number, directional: boolean }[]} lights
 * @param {Pass} pass
 */
export function lightsOf(lights, { seenFrom, views }) {
  const afar = seenFrom === 'distant light' ? lights.filter(({ directional }) => directional) : [];
  const shining = (afar.length ? afar : lights).filter(({ strength }) => strength > 0);
  return shining.sort((a, b) => b.strength - a.strength).slice(0, Math.max(views.length, 1)).map(({ light }) => light);
}

/**
 * World space to (u w, v w, distance from the plane where a view begins, w) in a tile of a picture.
 * @param {ArrayLike<number>} clip world space to clip space, by columns
 * @param {ArrayLike<number>} view world space to the light's
 * @param {number} forwards the sign of z in front of the light
 * @param {number} start where it begins, in front of the light: distances in a picture count from there
 * @param {number} up the sign of v upwards in clip space
 */
export function viewNumbers(clip, view, forwards, start, up, { x: column, y: row }, { across, up: rows }) {
  return [0, 4, 8, 12].flatMap((at) => {
    const [x, y, w] = [clip[at], clip[at + 1], clip[at + 3]];
    return [((column + 0.5) * w + 0.5 * x) / across, ((row + 0.5) * w + 0.5 * up * y) / rows, forwards * view[at + 2] - (at === 12 ? start : 0), w];
  });
}
