// What materials by sssgen for PlayCanvas share: their class, and the way of their text into PlayCanvas's chunks. sssgen writes
// this file beside the materials; it is the same for all of them.

import * as pc from 'playcanvas';
import { Properties, TEXELS } from './values.js';

/**
 * A material's text in one language: what it adds to PlayCanvas's chunks.
 * @typedef {object} Shell
 * @property {string} functions
 * @property {string} vertex the values of varyings without an attribute
 * @property {string} begin the variables' values, and the surface
 * @property {{ front?: string, opacity?: string, ambient?: string }} places the surface's way into PlayCanvas's arguments of
 *   the light, into its opacity, and into the ambient light
 * @property {string} [translucency] the share of a light that comes through
 * @property {string} [lighting] the reflected light
 */

/**
 * What the vertex shader passes on: the value of an attribute, or the default where the mesh has none.
 * @typedef {object} Varying
 * @property {string} type
 * @property {string} [attribute]
 * @property {string} [semantic]
 * @property {string} [define] with which PlayCanvas declares the attribute itself
 * @property {number} [default]
 */

/**
 * A material, as its module describes it.
 * @typedef {object} Description
 * @property {string} name
 * @property {number} version
 * @property {boolean} [lit] whether PlayCanvas lights it
 * @property {boolean} [twoSided]
 * @property {'mask' | 'blend'} [alphaMode] opaque, if it has none
 * @property {string[]} [fields] the members of its surface
 * @property {string[]} inputs the values that its functions read
 * @property {Record<string, import('./values.js').Parameter>} parameters
 * @property {Record<string, import('./values.js').TextureParameter>} textures
 * @property {Record<string, Varying>} varyings
 * @property {Record<string, string>} variables of the fragment shader: name → type
 * @property {Shell[]} shells in GLSL and in WGSL
 */

// Chunks: PlayCanvas's own text stays, and the material's text is added.

const SCALARS = { float: 'f32', int: 'i32', uint: 'u32', bool: 'u32' };
const TEXTURE_TYPES = { sampler2D: '2d', sampler3D: '3d', samplerCube: 'cube', sampler2DArray: '2d_array' };
const wgslType = (type) => SCALARS[type]
  ?? type.replace(/^([iu]?)vec(\d)/, (_, kind, size) => `vec${size}${kind || 'f'}`).replace(/^mat(\d)/, 'mat$1x$1f');

/** GLSL, and the same in WGSL: a declaration with a keyword, a variable, and the head of a function. */
const LANGUAGES = [
  {
    declared: (keyword, type, name) => `${keyword} ${type} ${name};`,
    variable: (type, name) => `${type} ${name};`,
    head: (text) => text,
  },
  {
    declared: (keyword, type, name) => `${keyword} ${name}: ${wgslType(type)};`,
    variable: (type, name) => `var<private> ${name}: ${wgslType(type)};`,
    head(text) {
      const [, result, name, params] = /** @type {RegExpMatchArray} */ (text.match(/^(\w+) (\w+)\((.*)\)$/));
      const typed = params.replace(/(\w+) (\w+)/g, (_, type, param) => `${param}: ${wgslType(type)}`);
      return `fn ${name}(${typed})${result === 'void' ? '' : ` -> ${wgslType(result)}`}`;
    },
  },
];

/** The declarations of the uniforms and textures. */
function declarations({ parameters, textures }, { moves, takesLight }, gpu) {
  const uniforms = Object.values(parameters).map(({ type, name }) => [type, name]);
  if (moves) uniforms.push(['float', 'sss_time']);
  if (takesLight) uniforms.push(['vec4', 'sss_light_place'], ['vec3', 'sss_light_radiance']);
  const read = Object.values(textures);
  const { declared } = LANGUAGES[Number(gpu)];
  const lines = uniforms.map(([type, name]) => declared('uniform', type, name));
  if (gpu) return [...lines, ...read.map(({ type, name }) => `var ${name}: texture_${TEXTURE_TYPES[type]}<f32>;\nvar ${name}_sampler: sampler;`)];
  return [
    ...[...new Set(read.map(({ type }) => type))].map((type) => `precision highp ${type};`),
    ...lines,
    ...read.map(({ type, name }) => `uniform highp ${type} ${name};`),
  ];
}

/** The variables of the light that comes through, and of that which the material reflects itself. */
const LIGHT = { sss_L: 'vec3', sss_light_color: 'vec3', sss_light_nearness: 'float', sss_light_sum: 'vec3' };

/** What is added to PlayCanvas's chunks as it is: the declarations, and the varyings' values. */
function additions(description, properties, gpu) {
  const own = description.shells[Number(gpu)];
  const { declared, variable } = LANGUAGES[Number(gpu)];
  const varyings = Object.entries(description.varyings);
  const attributes = varyings.filter(([, { attribute }]) => attribute);
  const passed = varyings.map(([name, { type }]) => declared('varying', type, name));
  const variables = Object.entries({ ...description.variables, ...(description.lit ? LIGHT : {}) });
  const out = gpu ? 'output.' : '';
  // in a cluster each pixel has lights of its own, and WGSL refuses reads with derivatives there
  const perLight = `${own.translucency} ${own.lighting}`;
  const readsPerLight = Object.values(description.textures).some(({ name }) => perLight.includes(name));
  const functions = gpu && readsPerLight ? own.functions.replaceAll('\nfn ', '\n@diagnostic(off, derivative_uniformity) fn ') : own.functions;
  const texts = {
    litUserDeclarationVS: [
      ...passed,
      ...attributes.map(([, { type, attribute, semantic, define }]) => `
#if defined(SSS_${semantic}) && !defined(${define})
${declared('attribute', type, attribute)}
#endif`),
    ],
    litUserMainEndVS: [
      ...attributes.map(([name, { type, attribute, semantic, default: other }]) => `
#ifdef SSS_${semantic}
${out}${name} = ${attribute};
#else
${out}${name} = ${type}(${other}.0);
#endif`),
      own.vertex,
    ],
    litUserDeclarationPS: [
      ...declarations(description, properties, gpu), ...passed, functions, ...variables.map(([name, type]) => variable(type, name)),
    ],
  };
  return Object.entries(texts).map(([chunk, lines]) => [chunk, `\n${lines.join('\n')}\n`]);
}

/**
 * Changes of PlayCanvas's chunks: a chunk, what is sought in it, what it becomes, and what follows the chunk.
 * @returns {[string, RegExp, string, string][]}
 */
function changes({ lit, shells }, gpu) {
  const own = shells[Number(gpu)];
  const { front = '', opacity = '', ambient = '' } = own.places;
  const { head } = LANGUAGES[Number(gpu)];
  return [
    ['stdFrontEndPS', /evaluateFrontend/, 'sss_engine_front', `
${head('void evaluateFrontend()')} {
${lit ? 'sss_light_sum = vec3(0.0);' : ''}
${own.begin}
  sss_engine_front();
#ifdef FORWARD_PASS
${front}
#endif
}
${lit ? lightFunctions(own, head) : ''}`],
    ['opacityPS', /getOpacity/, 'sss_engine_opacity', `
${head('void getOpacity()')} {
  sss_engine_opacity();
${opacity}
}
`],
    ['combinePS', /combineColor/, 'sss_engine_combine', `
${lit && !gpu ? AMBIENT_DECLARATION : ''}
${head('vec3 combineColor(vec3 albedo, vec3 sheenSpecularity, float clearcoatSpecularity)')} {
${lit ? lightSum(ambient) : 'return vec3(0.0);'}
}
`],
    ...(lit ? lightChanges(gpu, head) : []),
  ];
}

const AMBIENT_DECLARATION = `
#if defined(SSS_OWN_LIGHT) && defined(LIT_ADD_AMBIENT)
void addAmbient(vec3 worldNormal);
#endif`;

const lightSum = (ambient) => `
#ifdef SSS_OWN_LIGHT
#ifdef LIT_ADD_AMBIENT
dDiffuseLight = vec3(0.0);
addAmbient(litArgs_worldNormal);
${ambient}
sss_light_sum += dDiffuseLight;
#endif
return sss_light_sum;
#else
return sss_engine_combine(albedo, sheenSpecularity, clearcoatSpecularity) + sss_light_sum;
#endif`;

/** One of PlayCanvas's lights: what comes through has no shadow, as it entered on the far side. */
const lightFunctions = ({ translucency, lighting }, head) => `
${head('void sss_light_through(vec3 L, vec3 color, float nearness)')} {
  sss_L = L;
  sss_light_color = color;
  sss_light_nearness = nearness;
${translucency ? `sss_light_sum += color * ${translucency};` : ''}
}
#ifdef SSS_OWN_LIGHT
${head('void sss_light_reflected(vec3 color)')} {
  sss_light_color = color;
  sss_light_sum += ${lighting};
}
#endif
`;

/**
 * Those of a lit material.
 * @returns {[string, RegExp, string, string][]}
 */
const lightChanges = (gpu, head) => [
  ['lightDiffuseLambertPS', /getLightDiffuse/, 'sss_engine_lambert', `
${head('float getLightDiffuse(vec3 worldNormal, vec3 viewDir, vec3 lightDirNorm)')} {
#ifdef SSS_OWN_LIGHT
  return 1.0;
#else
  return sss_engine_lambert(worldNormal, viewDir, lightDirNorm);
#endif
}
`],
  ['lightFunctionLightPS', /(?=dAtten\b[^;\n]*getLightDiffuse)/, `
#if LIGHT{i}TYPE == DIRECTIONAL
sss_light_through(-dLightDirNormW, lightColor * dAtten, 0.0);
#else
sss_light_through(-dLightDirNormW, lightColor * dAtten, 1.0 / max(length(lightDirW), 0.01));
#endif
`, ''],
  ['lightFunctionLightPS', /(?=#ifdef LIGHT\{i\}AFFECT_SPECULARITY)/, `
#if defined(SSS_OWN_LIGHT) && LIGHT{i}SHAPE == PUNCTUAL
sss_light_reflected(lightColor * dAtten);
#endif
`, ''],
  ['clusteredLightPS', /(?=falloffAttenuation\b[^;\n]*getLightDiffuse)/, `
${gpu ? 'var' : 'float'} sss_arriving = falloffAttenuation;
if (light.isSpot) {
  ${gpu ? 'let' : 'ClusterLightSpotData'} spot = decodeClusterLightSpot();
  sss_arriving *= getSpotEffect(light.direction, spot.innerConeAngleCos, spot.outerConeAngleCos, lightDirNormW);
}
sss_light_through(-lightDirNormW, light.color * sss_arriving, 1.0 / max(length(lightDirW), 0.01));
`, ''],
  ['clusteredLightPS', /(?=dAtten = falloffAttenuation;)/, `
#ifdef SSS_OWN_LIGHT
if (light.shape == {LIGHTSHAPE_PUNCTUAL}) { sss_light_reflected(light.color * cookieAttenuation * falloffAttenuation); }
#endif
`, ''],
];

/** Gives a material its chunks. */
function setChunks(material, device, description, properties) {
  const gpu = device.isWebGPU;
  const language = gpu ? pc.SHADERLANGUAGE_WGSL : pc.SHADERLANGUAGE_GLSL;
  const engine = pc.ShaderChunks.get(device, language);
  const chunks = material.getShaderChunks(language);
  for (const [name, text] of additions(description, properties, gpu)) chunks.set(name, (engine.get(name) ?? '') + text);
  for (const [name, sought, instead, after] of changes(description, gpu)) {
    const chunk = chunks.get(name) ?? engine.get(name) ?? '';
    if (!sought.test(chunk)) throw new Error(`${description.name}: this version of PlayCanvas has no ${sought.source} in its chunk ${name}`);
    chunks.set(name, chunk.replace(sought, () => instead) + after);
  }
}

// Textures and values.

/** A texture of one texel, in half floats, which every device filters. */
function texel(device, material, { type, default: name }) {
  const data = new Uint16Array(TEXELS[name].map((value) => pc.FloatPacking.float2Half(value)));
  const [cube, volume, layers] = ['samplerCube', 'sampler3D', 'sampler2DArray'].map((one) => one === type);
  return new pc.Texture(device, {
    name: `${material} ${name}`, width: 1, height: 1, format: pc.PIXELFORMAT_RGBA16F, mipmaps: false,
    cubemap: cube, volume, depth: 1, arrayLength: layers ? 1 : 0, minFilter: pc.FILTER_LINEAR, magFilter: pc.FILTER_LINEAR,
    levels: /** @type {any} */ ([cube ? Array(6).fill(data) : layers ? [data] : data]),
  });
}

const filled = new WeakSet();

/** PlayCanvas 2.23 leaves the texels of volumes out in WebGPU: here they follow, once. */
function withTexels(texture) {
  const { impl, device } = texture;
  if (!texture.volume || impl.desc?.dimension !== '3d' || filled.has(texture)) return texture;
  filled.add(texture);
  const size = { width: texture.width, height: texture.height, depthOrArrayLayers: texture.depth };
  const data = texture.getSource();
  Object.assign(impl.desc, { size, mipLevelCount: 1 });
  impl.gpuTexture = device.wgpu.createTexture(impl.desc);
  impl.view = impl.gpuTexture.createView({ dimension: '3d' });
  const layout = { bytesPerRow: data.byteLength / (size.height * size.depthOrArrayLayers), rowsPerImage: size.height };
  device.wgpu.queue.writeTexture({ texture: impl.gpuTexture }, data, layout, size);
  return texture;
}

/** A value as the shader takes it; a pc.Color is converted to linear light. */
function numbersOf(value, type) {
  if (value instanceof pc.Color) {
    const { r, g, b, a } = new pc.Color().linear(value);
    return [r, g, b, a].slice(0, type === 'vec3' ? 3 : 4);
  }
  if (Array.isArray(value)) return [...value];
  if (typeof value === 'boolean') return Number(value);
  return value?.data ? Array.from(value.data) : value?.toArray ? value.toArray([]) : value;
}

// The class of materials.

/**
 * The class of a material: StandardMaterial with the material's properties and chunks.
 * @param {Description} description
 */
export function materialClass(description) {
  const { name: materialName, lit, twoSided, alphaMode, fields = [], parameters, textures } = description;
  const properties = new Properties(description, 'StandardMaterial');
  const { moves, takesLight } = properties;

  return class extends pc.StandardMaterial {
    #device;

    constructor(device, values = {}) {
      if (typeof device?.isWebGPU !== 'boolean') properties.refuse('createMaterial', 'a graphics device first, such as app.graphicsDevice', device);
      super();
      this.#device = device;
      this.name = materialName;
      this.useMetalness = true;
      if (lit) {
        this.metalness = 0;
        this.gloss = 0;
        this.enableGGXSpecular = true; // which the surface's roughness is meant for
      } else {
        this.useLighting = false;
        this.useSkybox = false;
      }
      if (fields.includes('clearcoat')) this.clearCoat = 1; // PlayCanvas has none at 0; the surface has its weight
      if (fields.includes('sheen_color')) this.useSheen = true;
      if (twoSided) this.cull = pc.CULLFACE_NONE;
      if (twoSided) this.twoSidedLighting = true;
      if (alphaMode === 'mask') this.alphaTest = 0.5;
      if (alphaMode === 'blend') this.blendType = pc.BLEND_NORMAL;
      if (alphaMode === 'blend') this.depthWrite = false;
      if (fields.includes('occlusion')) ['LIT_AO', 'STD_AO'].forEach((define) => this.setDefine(define, ''));
      /** In seconds; null: the page's clock. */
      if (moves) this.time = null;
      /** A light component, which lights this unlit material; null: none. */
      if (takesLight) this.light = null;
      setChunks(this, device, description, properties);
      for (const [property, declared] of Object.entries(parameters)) this[property] = declared.default;
      for (const property of Object.keys(textures)) this[property] = null;
      this.set(values);
      this.update();
    }

    static {
      for (const [property, { name }] of Object.entries(parameters)) {
        properties.define(this.prototype, property, {
          get() { return this.getParameter(name).data; },
          set(value) { this.#setNumbers(property, value); },
        });
      }
      for (const [property, { name }] of Object.entries(textures)) {
        properties.define(this.prototype, property, {
          get() { return this.getParameter(name).data; },
          set(value) { this.#setTexture(property, value); },
        });
      }
      if (lit) {
        /** Whether the reflected light is that of the targets without an engine, the same picture everywhere. */
        Object.defineProperty(this.prototype, 'ownLight', {
          get() { return this.getDefine('SSS_OWN_LIGHT'); },
          set(value) { this.setDefine('SSS_OWN_LIGHT', value ? '' : undefined); },
        });
      }
    }

    #setNumbers(property, value) {
      const { type, name } = parameters[property];
      const mayBeColor = type === 'vec3' || type === 'vec4';
      const color = mayBeColor && /^#([0-9a-f]{2}){3,4}$/i.test(value) ? new pc.Color().fromString(value) : value;
      const colors = mayBeColor ? ", a pc.Color, or a colour such as '#3070ff'" : '';
      const numbers = properties.numbers(property, mayBeColor ? numbersOf(color, type) : color, colors);
      this.setParameter(name, numbers.length > 1 ? numbers : numbers[0]);
    }

    #setTexture(property, value) {
      if (!(value == null || value instanceof pc.Texture)) properties.refuse(property, 'a pc.Texture, or null', value);
      if (value) properties.checkKind(property, { cube: value.cubemap, volume: value.volume, layers: value.array });
      const declared = textures[property];
      this.setParameter(declared.name, withTexels(value ?? texel(this.#device, materialName, declared)));
    }

    /** Sets many properties: those of the material, and those of StandardMaterial. */
    set(values) {
      properties.checkNames(this, values);
      Object.assign(this, values);
      return this;
    }

    /** PlayCanvas calls this for each format of vertices: the shader reads the attributes that the mesh has. */
    getShaderVariant(params) {
      const { defines } = this;
      this.defines = new Map(defines);
      for (const { name } of params.vertexFormat?.elements ?? []) this.defines.set(`SSS_${name}`, '');
      try {
        return super.getShaderVariant(params);
      } finally {
        this.defines = defines;
      }
    }

    /** PlayCanvas calls this before it draws. */
    setParameters(device, names) {
      if (moves) this.setParameter('sss_time', this.time ?? performance.now() / 1000);
      if (takesLight) this.#setLight(this.light);
      super.setParameters(device, names);
    }

    #setLight(light) {
      const directional = light?.type === 'directional';
      const place = directional ? light.entity.up : light?.entity.getPosition();
      this.setParameter('sss_light_place', place ? [place.x, place.y, place.z, directional ? 0 : 1] : [0, 1, 0, 0]);
      const radiance = light ? numbersOf(light.color, 'vec3').map((value) => value * light.intensity) : [0, 0, 0];
      this.setParameter('sss_light_radiance', radiance);
    }

    clone() {
      const Own = /** @type {any} */ (this.constructor);
      const copy = new Own(this.#device).copy(this);
      return Object.assign(copy, moves && { time: this.time }, takesLight && { light: this.light });
    }
  };
}
