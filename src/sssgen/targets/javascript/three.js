// What materials by sssgen for three.js share: their class, their nodes for WebGPURenderer, and the way of their text into the
// shaders of WebGLRenderer. sssgen writes this file beside the materials; it is the same for all of them.

import * as THREE from 'three/webgpu';
import * as TSL from 'three/tsl';
import { spreadOf } from './frame_passes.js';
import { nodesOf } from './three_nodes.js';
import { ObjectUniforms, placedValue } from './three_object.js';
import { Passes } from './three_passes.js';
import { REST_POSE } from './three_rest_pose.js';
import { entryChunks, entryFunction } from './three_shadows.js';
import { SURROUNDINGS } from './three_surroundings.js';
import { Properties, TEXELS } from './values.js';

/**
 * A material, as its module describes it.
 * @typedef {object} Description
 * @property {string} name
 * @property {number} version
 * @property {boolean} [lit] whether three lights it
 * @property {boolean} [screen] whether it makes a picture of its own: the position of the mesh means nothing
 * @property {boolean} [twoSided]
 * @property {'mask' | 'blend'} [alphaMode] opaque, if it has none
 * @property {string[]} [fields] the members of its surface
 * @property {Record<string, import('./values.js').Parameter>} parameters
 * @property {Record<string, import('./values.js').TextureParameter>} textures
 * @property {import('./frame_passes.js').Pass[]} [passes] what is drawn before it, in order
 * @property {import('./frame_passes.js').Area} [area] where light comes through
 * @property {string} glsl functions
 * @property {string} wgsl the same
 * @property {Record<string, import('./three_nodes.js').Call>} calls `color` of an unlit material; `surface` and `translucency` of a lit one
 * @property {WebglTexts} webgl
 */

/**
 * What goes into the shaders of WebGLRenderer.
 * @typedef {object} WebglTexts
 * @property {string} varyings
 * @property {string} vertex_attributes
 * @property {string} vertex statements of the vertex shader
 * @property {string} variables
 * @property {string} fragment statements of the fragment shader
 * @property {string} [light] statements for each light, where light comes through
 * @property {string} [entry] the same for the function of the point where it entered
 * @property {Record<string, string>} includes three's include → the statements behind it
 */

// WebGLRenderer: the functions go into three's own shader, at its includes.

/** The uniforms beside parameters and textures. */
const OWN_UNIFORMS = {
  time: { type: 'float', name: 'sss_time' },
  lightPlace: { type: 'vec4', name: 'sss_light_place' },
  lightRadiance: { type: 'vec3', name: 'sss_light_radiance' },
  bodyMin: { type: 'vec3', name: 'sss_body_min' },
  bodyMax: { type: 'vec3', name: 'sss_body_max' },
};

/** What three gives its functions for a light beside the light. */
const POINT = {
  parameters: 'const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight',
  names: 'geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight',
};

/**
 * What three calls for each light: its own reflection, then the light that comes through. The macros remember the light's
 * colour before its shadow: light that comes through has that of the point where it entered. A rectangle of light is
 * four lights.
 */
const lightFunction = ({ area, passes, webgl: { light, entry } }) => /* glsl */ `
vec3 sss_light_color;
float sss_light_nearness;
#define SSS_LIGHT(direct, nearness) sss_light_color = direct.color; sss_light_nearness = nearness
#define getPointLightInfo(light, at, direct) getPointLightInfo(light, at, direct); SSS_LIGHT(direct, 1.0 / max(length(light.position - at), 0.01))
#define getSpotLightInfo(light, at, direct) getSpotLightInfo(light, at, direct); SSS_LIGHT(direct, 1.0 / max(length(light.position - at), 0.01))
#define getDirectionalLightInfo(light, direct) getDirectionalLightInfo(light, direct); SSS_LIGHT(direct, 0.0)
#define getSunLightInfo(light, direct) getSunLightInfo(light, direct); SSS_LIGHT(direct, 0.0)

void sss_through(const in IncidentLight directLight, const in vec3 geometryNormal, inout ReflectedLight reflectedLight) {
${light}}

void sss_direct(const in IncidentLight directLight, ${POINT.parameters}) {
  RE_Direct_Physical(directLight, ${POINT.names});
  sss_through(directLight, geometryNormal, reflectedLight);
}
#undef RE_Direct
#define RE_Direct sss_direct

#if NUM_RECT_AREA_LIGHTS > 0
void sss_direct_area(const in RectAreaLight rectAreaLight, ${POINT.parameters}) {
  RE_Direct_RectArea_Physical(rectAreaLight, ${POINT.names});
  mat3 area = mat3(rectAreaLight.position - geometryPosition, rectAreaLight.halfWidth, rectAreaLight.halfHeight);
  for (int index = 0; index < 4; index ++) {
    vec4 way = ${area.towards}(index, ${spreadOf(passes)}, area);
    sss_light_color = rectAreaLight.color * max(${area.light}(area, way), 0.0);
    sss_light_nearness = way.w;
    sss_through(IncidentLight(sss_light_color, way.xyz, true), geometryNormal, reflectedLight);
  }
}
#undef RE_Direct_RectArea
#define RE_Direct_RectArea sss_direct_area
#endif
${entryFunction(entry)}`;

/** The texts with the values of the rest pose, of a body that bones move or of any other. */
function withRestPose(webgl, skinned) {
  const { varyings, vertex, variables } = skinned ? REST_POSE.skinned : REST_POSE.rigid;
  return { ...webgl, varyings: webgl.varyings + varyings, vertex: webgl.vertex + vertex, variables: webgl.variables + variables };
}

/** Adds a material's text to a shader of three: behind its includes, and in place of two of them. */
function patch(shader, description, uniforms) {
  const { name, parameters, textures, calls, glsl } = description;
  const isAtRest = Object.values(calls).some(({ inputs }) => inputs.some((input) => input.endsWith('_rest')));
  const webgl = isAtRest ? withRestPose(description.webgl, shader.skinning) : description.webgl;
  const declarations = [];
  for (const [property, declared] of Object.entries({ ...parameters, ...textures, ...OWN_UNIFORMS })) {
    if (!uniforms[property]) continue;
    declarations.push(`uniform ${declared.type} ${declared.name};`);
    shader.uniforms[declared.name] = uniforms[property];
  }
  const replace = (stage, file, textOf) => {
    const include = `#include <${file}>`;
    if (!shader[stage].includes(include)) throw new Error(`${name}: this version of three.js has no ${include}`);
    shader[stage] = shader[stage].replace(include, () => textOf(include));
  };
  const texts = {
    vertexShader: { common: webgl.varyings + webgl.vertex_attributes, project_vertex: webgl.vertex },
    fragmentShader: {
      common: declarations.join('\n') + webgl.varyings + glsl + webgl.variables, map_fragment: webgl.fragment, ...webgl.includes,
    },
  };
  const light = webgl.light ? lightFunction(description) : '';
  const around = webgl.fragment.includes('sss_surroundings(') ? SURROUNDINGS : '';
  if (light || around) texts.fragmentShader.lights_physical_pars_fragment = light + around;
  for (const [stage, behind] of Object.entries(texts)) {
    for (const [file, text] of Object.entries(behind)) replace(stage, file, (include) => `${include}\n${text}`);
  }
  if (!webgl.light) return;
  for (const [file, text] of Object.entries(entryChunks(name))) replace('fragmentShader', file, () => text);
}

// The class of materials.

/**
 * The first value of a parameter, as a user gets it.
 * @param {import('./values.js').Parameter} declared
 */
function startOf({ type, default: start, color }) {
  if (!Array.isArray(start)) return start;
  if (color) return new THREE.Color().fromArray(start);
  return new THREE[`${type.startsWith('mat') ? 'Matrix' : 'Vector'}${type.at(-1)}`]().fromArray(start);
}

/** A texture of one texel, in half floats, which every device filters. */
function texel({ type, default: name }) {
  const data = new Uint16Array(TEXELS[name].map((value) => THREE.DataUtils.toHalfFloat(value)));
  const settings = {
    format: THREE.RGBAFormat, type: THREE.HalfFloatType, wrapS: THREE.RepeatWrapping, wrapT: THREE.RepeatWrapping,
    magFilter: THREE.LinearFilter, minFilter: THREE.LinearFilter, needsUpdate: true,
  };
  const flat = () => Object.assign(new THREE.DataTexture(data, 1, 1), settings);
  if (type === 'sampler2D') return flat();
  if (type === 'samplerCube') return Object.assign(new THREE.CubeTexture(Array.from({ length: 6 }, flat)), settings);
  return Object.assign(new THREE[type === 'sampler3D' ? 'Data3DTexture' : 'DataArrayTexture'](data, 1, 1, 1), settings);
}

const IDENTITY = new THREE.Matrix3();

/** Whether three would transform coordinates for a texture. */
function isTransformed(texture) {
  if (texture.matrixAutoUpdate) texture.updateMatrix();
  return !texture.matrix.equals(IDENTITY);
}

const TEXTURE_NODES = { sampler3D: TSL.texture3D, samplerCube: TSL.cubeTexture };

/**
 * The uniforms of a material, as nodes that both renderers read. `own` gets what a page sets: of a parameter that is placed with
 * the object, the value before.
 */
function uniformsOf({ parameters, textures, calls }, moves, takesLight, ofObject, own) {
  const uniforms = {};
  for (const [name, declared] of Object.entries(parameters)) {
    const start = startOf(declared);
    if (declared.placed) uniforms[name] = ofObject.uniform(start, (object) => placedValue(own[name].value, object));
    else uniforms[name] = ['int', 'uint'].includes(declared.type) ? TSL.uniform(start, declared.type) : TSL.uniform(start);
    own[name] = declared.placed ? { value: startOf(declared) } : uniforms[name];
  }
  for (const [name, declared] of Object.entries(textures)) {
    const node = (TEXTURE_NODES[declared.type] ?? TSL.texture)(texel(declared));
    // of a picture with nearest filters, WebGPU has a sampler only where it is gathered
    uniforms[name] = Object.assign(node, { gatherNode: TSL.int(0) });
  }
  if (moves) uniforms.time = TSL.uniform(0);
  if (takesLight) uniforms.lightPlace = TSL.uniform(new THREE.Vector4(0, 1, 0, 0));
  if (takesLight) uniforms.lightRadiance = TSL.uniform(new THREE.Color(0, 0, 0));
  if (calls.translucency) Object.assign(uniforms, ofObject.box());
  return uniforms;
}

/**
 * The class of a material: MeshPhysicalMaterial, or MeshBasicMaterial for an unlit one, with the material's properties.
 * @param {Description} description
 */
export function materialClass(description) {
  const { name, lit, parameters, textures, calls, fields = [], passes = [] } = description;
  const base = lit ? 'MeshPhysicalMaterial' : 'MeshBasicMaterial';
  const inputs = Object.values(calls).flatMap((call) => call.inputs);
  const properties = new Properties({ ...description, inputs }, base);
  const { moves, takesLight } = properties;
  const isDrawn = (property) => passes.some((pass) => pass.texture === property);
  const texts = { glsl: TSL.glsl(description.glsl), wgsl: TSL.wgsl(description.wgsl) };
  // three keeps one program per key
  const key = `sssgen ${name} ${Properties.hashOf(JSON.stringify([description.glsl, description.webgl, description.area, passes]))}`;

  return class extends THREE[base] {
    #ofObject = new ObjectUniforms();
    /** @type {Record<string, { value: any }>} */
    #own = {};
    #uniforms = uniformsOf(description, moves, takesLight, this.#ofObject, this.#own);
    #passes = new Passes(passes);
    /** The textures that the page has set. */
    #given = new Set();

    constructor(values = {}) {
      super();
      this.name = name;
      if (lit) this.roughness = 1;
      if (fields.includes('clearcoat')) this.clearcoat = 1; // three has none at 0; the surface has its weight
      if (fields.includes('sheen_color')) Object.assign(this, { sheen: 1, sheenColor: new THREE.Color(1, 1, 1) }); // likewise
      if (description.twoSided) this.side = THREE.DoubleSide;
      if (description.alphaMode === 'mask') this.alphaTest = 0.5;
      if (description.alphaMode === 'blend') this.transparent = true;
      if (inputs.includes('vertex_color')) this.defaultAttributeValues = { color: [1, 1, 1, 1] }; // in WebGLRenderer
      if (moves) {
        /** In seconds; null: the page's clock. */
        this.time = null;
        this.#uniforms.time.onRenderUpdate(() => this.#seconds());
      }
      if (takesLight) {
        /** One of three's lights, which lights this unlit material; null: none. */
        this.light = null;
        this.#uniforms.lightPlace.onRenderUpdate(() => this.#placeLight());
      }
      const nodes = nodesOf(description, texts, this.#uniforms);
      // in WebGPURenderer, whose shadow maps have the colour in a material of their own
      const updateBefore = (frame) => { if (frame.material === this) this.#prepare(frame); };
      Object.assign(nodes.colorNode, { updateBeforeType: 'object', updateBefore });
      Object.assign(this, nodes);
      this.setValues(values);
    }

    static {
      for (const property of Object.keys(parameters)) {
        properties.define(this.prototype, property, {
          get() { return this.#own[property].value; },
          set(value) { this.#setParameter(property, value); },
        });
      }
      for (const property of Object.keys(textures)) {
        properties.define(this.prototype, property, {
          get() { return this.#passes.responses.get(property) ?? this.#uniforms[property].value; },
          set(value) { this.#setTexture(property, value); },
        });
      }
    }

    #setParameter(property, value) {
      const node = this.#own[property];
      const isColor = node.value.isColor && (typeof value === 'string' || typeof value === 'number');
      const color = isColor && new THREE.Color(NaN, NaN, NaN).set(value); // which a string that it does not know leaves
      const given = color && Number.isFinite(color.r) ? color : value;
      const numbers = properties.numbers(property, given, node.value.isColor ? ', or a colour as THREE.Color takes it' : '');
      if (typeof node.value === 'object') node.value.fromArray(numbers);
      else node.value = parameters[property].type === 'bool' ? Boolean(numbers[0]) : numbers[0];
    }

    #setTexture(property, value) {
      const declared = textures[property];
      if (this.#passes.responses.take(property, value, (name, numbers) => name in parameters && this.#setParameter(name, numbers))) {
        this.#given.delete(property);
        return;
      }
      if (!(value?.isTexture ?? value == null)) properties.refuse(property, 'a THREE.Texture, or null', value);
      if (value) {
        const volume = value.isData3DTexture || value.is3DTexture, layers = value.isDataArrayTexture || value.isArrayTexture;
        properties.checkKind(property, { cube: value.isCubeTexture, volume, layers });
      }
      const decoded = value?.type === THREE.HalfFloatType || value?.type === THREE.FloatType;
      if (value?.colorSpace === THREE.NoColorSpace && !decoded) value.colorSpace = declared.colorSpace;
      if (value) this.#given.add(property);
      else this.#given.delete(property);
      this.#uniforms[property].value = value ?? texel(declared);
      this.needsUpdate = true;
    }

    setValues(values) {
      properties.checkNames(this, values);
      const others = {};
      for (const [property, value] of Object.entries(values ?? {})) {
        if (properties.names.includes(property)) this[property] = value;
        else others[property] = value;
      }
      super.setValues(others);
    }

    #seconds() {
      return this.time ?? performance.now() / 1000;
    }

    #placeLight() {
      const { light } = this, { lightPlace, lightRadiance } = this.#uniforms;
      if (!light) {
        lightRadiance.value.setScalar(0);
        return lightPlace.value;
      }
      light.updateWorldMatrix(true, false);
      const place = new THREE.Vector3().setFromMatrixPosition(light.matrixWorld);
      if (light.isDirectionalLight) {
        light.target.updateWorldMatrix(true, false);
        place.sub(new THREE.Vector3().setFromMatrixPosition(light.target.matrixWorld));
      }
      lightRadiance.value.copy(light.color).multiplyScalar(light.intensity / Math.PI);
      return lightPlace.value.set(place.x, place.y, place.z, light.isDirectionalLight ? 0 : 1);
    }

    /** Before an object is drawn: draws its passes. @param {{ renderer: any, scene: THREE.Scene, camera: THREE.Camera, object: THREE.Mesh }} frame */
    #prepare(frame) {
      properties.checkTextures((property) => this.#given.has(property) && this.#uniforms[property].value, isTransformed, this.#passes.responses);
      this.#passes.draw(frame, (property) => this.#given.has(property), (property, value) => {
        const node = this.#uniforms[property];
        if (value.isMatrix4) node.value.copy(value);
        else node.value = value;
      });
    }

    onBeforeRender(renderer, scene, camera, geometry, object) {
      this.#prepare({ renderer, scene, camera, object });
      this.#ofObject.place(object, renderer);
      if (moves) this.#uniforms.time.value = this.#seconds();
      if (takesLight) this.#placeLight();
      if (moves || takesLight || passes.length) this.uniformsNeedUpdate = true;
    }

    dispose() {
      super.dispose();
      this.#passes.dispose();
    }

    onBeforeCompile(shader) {
      patch(shader, description, this.#uniforms);
    }

    customProgramCacheKey() {
      return [key, ...Object.keys(textures).map((property) => this[property].type)].join(' ');
    }

    copy(source) {
      super.copy(source);
      for (const property of properties.names) {
        const given = source.#given.has(property) || source.#passes.responses.has(property);
        if (!isDrawn(property) || given) this[property] = source[property];
      }
      if (moves) this.time = source.time;
      if (takesLight) this.light = source.light;
      return this;
    }
  };
}
