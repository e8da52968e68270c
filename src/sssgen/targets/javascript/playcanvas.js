// What materials by sssgen for PlayCanvas share: their class, and the way of their text into PlayCanvas's chunks. sssgen writes
// this file beside the materials; it is the same for all of them.

import * as pc from 'playcanvas';
import { Responses } from './inner_volume.js';
import { setChunks } from './playcanvas_chunks.js';
import { Passes } from './playcanvas_passes.js';
import { withTexels } from './playcanvas_volume.js';
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
 * @property {string} [entry] the value of sss_entry: where that light entered the body
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
 * @property {import('./frame_passes.js').Area} [area] where light comes through
 * @property {Shell[]} shells in GLSL and in WGSL
 * @property {import('./frame_passes.js').Pass[]} [passes] what is drawn before it
 */

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

/** A value in the space of a body, for the world: a matrix takes positions of the world, a length is one there. */
function placedValue(value, world) {
  if (value.length) return Array.from(new pc.Mat4().mul2(new pc.Mat4().set(value), world.clone().invert()).data);
  const [x, y, z] = [world.getX(), world.getY(), world.getZ()];
  return value * Math.cbrt(Math.abs(x.dot(new pc.Vec3().cross(y, z))));
}

// The class of materials.

/**
 * The class of a material: StandardMaterial with the material's properties and chunks.
 * @param {Description} description
 */
export function materialClass(description) {
  const { name: materialName, lit, twoSided, alphaMode, fields = [], parameters, textures, shells } = description;
  const properties = new Properties(description, 'StandardMaterial');
  const { moves, takesLight } = properties;
  const placed = Object.keys(parameters).filter((property) => parameters[property].placed);

  return class extends pc.StandardMaterial {
    #device;
    /** The textures that the page has set. */
    #given = new Set();
    /** What it has set for volumes that are computed. */
    #responses = new Responses(description.passes ?? []);
    #passes;

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
      const { meshInstances } = /** @type {any} */ (this);
      this.#passes = new Passes(device, description, meshInstances, (property) => this.#given.has(property), this.#responses);
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
      if (this.#responses.take(property, value, (name, numbers) => name in parameters && this.#setNumbers(name, numbers))) value = null;
      if (!(value == null || value instanceof pc.Texture)) properties.refuse(property, 'a pc.Texture, or null', value);
      if (value) properties.checkKind(property, { cube: value.cubemap, volume: value.volume, layers: value.array });
      const declared = textures[property];
      if (value) this.#given.add(property);
      else this.#given.delete(property);
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
      if (!names) {
        this.#setBodies();
        properties.checkTextures((property) => this.#given.has(property), undefined, this.#responses);
      }
      this.#passes.follow();
      super.setParameters(device, names);
    }

    /** The values of each body that has the material: several may share it. */
    #setBodies() {
      for (const instance of /** @type {any} */ (this).meshInstances) {
        const { mesh, node } = instance, world = node.getWorldTransform();
        for (const property of placed) instance.setParameter(parameters[property].name, placedValue(this[property], world));
        if (!shells[0].entry) continue;
        instance.setParameter('sss_body_min', mesh.aabb.getMin().toArray());
        instance.setParameter('sss_body_max', mesh.aabb.getMax().toArray());
      }
    }

    #setLight(light) {
      const directional = light?.type === 'directional';
      const place = directional ? light.entity.up : light?.entity.getPosition();
      this.setParameter('sss_light_place', place ? [place.x, place.y, place.z, directional ? 0 : 1] : [0, 1, 0, 0]);
      const radiance = light ? numbersOf(light.color, 'vec3').map((value) => value * light.intensity) : [0, 0, 0];
      this.setParameter('sss_light_radiance', radiance);
    }

    destroy() {
      super.destroy();
      this.#passes.dispose();
    }

    clone() {
      const Own = /** @type {any} */ (this.constructor);
      const copy = new Own(this.#device).copy(this);
      for (const property of this.#given) copy[property] = this[property];
      return Object.assign(copy, Object.fromEntries(this.#responses), moves && { time: this.time }, takesLight && { light: this.light });
    }
  };
}
