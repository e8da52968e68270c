// What materials by sssgen for Babylon.js share: their class, and the plug-in that takes their text into Babylon's shaders. sssgen
// writes this file beside the materials; it is the same for all of them.

import { EngineStore } from '@babylonjs/core/Engines/engineStore.js';
import { ShaderStore } from '@babylonjs/core/Engines/shaderStore.js';
import { MaterialPluginBase } from '@babylonjs/core/Materials/materialPluginBase.js';
import { PBRMaterial } from '@babylonjs/core/Materials/PBR/pbrMaterial.js';
import { RawCubeTexture } from '@babylonjs/core/Materials/Textures/rawCubeTexture.js';
import { RawTexture } from '@babylonjs/core/Materials/Textures/rawTexture.js';
import { RawTexture2DArray } from '@babylonjs/core/Materials/Textures/rawTexture2DArray.js';
import { RawTexture3D } from '@babylonjs/core/Materials/Textures/rawTexture3D.js';
import { Texture } from '@babylonjs/core/Materials/Textures/texture.js';
import { Color3 } from '@babylonjs/core/Maths/math.color.js';
import { Matrix } from '@babylonjs/core/Maths/math.vector.js';
import { Vector3 } from '@babylonjs/core/Maths/math.vector.js';
import { Vector2, Vector4 } from '@babylonjs/core/Maths/math.vector.js';
import { SerializationHelper } from '@babylonjs/core/Misc/decorators.serialization.js';
import { lightOf } from './babylon_lights.js';
import { Passes } from './babylon_passes.js';
import { SKY, SURROUNDINGS, skyOf } from './babylon_surroundings.js';
import { spreadOf } from './frame_passes.js';
import { Responses } from './inner_volume.js';
import { Properties, TEXELS } from './values.js';

/**
 * A material, as its module describes it.
 * @typedef {object} Description
 * @property {string} name
 * @property {number} version
 * @property {boolean} [lit] whether Babylon lights it
 * @property {boolean} [twoSided]
 * @property {'mask' | 'blend'} [alphaMode] opaque, if it has none
 * @property {string[]} [fields] the members of its surface
 * @property {string[]} inputs the values that its functions read
 * @property {Record<string, import('./values.js').Parameter>} parameters
 * @property {Record<string, import('./values.js').TextureParameter>} textures
 * @property {import('./frame_passes.js').Pass[]} [passes] what is drawn before it, in order
 * @property {Record<string, string>} varyings name → type
 * @property {Record<string, string>} variables of the fragment shader: the same
 * @property {import('./frame_passes.js').Area} [area] where light comes through
 * @property {Shell[]} shells in GLSL and in WGSL
 */

/**
 * A material's text in one language.
 * @typedef {object} Shell
 * @property {string} functions
 * @property {string} vertex the varyings' values
 * @property {string} begin the variables' values, and the surface
 * @property {string} [translucency] the share of a light that comes through
 * @property {string} [entry] the value of sss_entry: where that light entered the body
 * @property {Record<string, string>} places place in Babylon's fragment shader → the way of the surface into it
 */

/** The uniforms in Babylon's block: type → number of floats. */
const SIZES = { float: 1, vec2: 2, vec3: 3, vec4: 4, mat4: 16 };
const uniformType = (type) => (type.startsWith('mat') ? 'mat4' : /\d/.test(type) ? `vec${type.at(-1)}` : 'float');

/** The declarations of a texture, of a varying and of a variable, in GLSL and in WGSL. */
const DECLARATIONS = [
  {
    texture: (name, type) => `uniform highp ${type} ${name};`,
    varying: (name, type) => `varying ${type} ${name};`,
    variable: (name, type) => `${type} ${name};`,
  },
  {
    texture: (name, type) => `var ${name}Sampler: sampler;\nvar ${name}: texture_${TEXTURE_TYPES[type]}<f32>;`,
    varying: (name, type) => `varying ${name}: ${type}f;`,
    variable: (name, type) => `var<private> ${name}: ${WGSL_TYPES[type] ?? type.replace(/^vec./, '$&f')};`,
  },
];
const TEXTURE_TYPES = { sampler2D: '2d', sampler3D: '3d', samplerCube: 'cube', sampler2DArray: '2d_array' };
const WGSL_TYPES = { bool: 'bool', float: 'f32', mat3: 'mat3x3f' };
const declared = (declaration, types) => Object.entries(types).map(([name, type]) => `${declaration(name, type)}\n`).join('');

/** Where a function of Babylon takes a variable of the material in place of a value of its own: what is sought, and its text then. */
const ARGUMENTS = {
  sss_reflectivity: [
    '!reflectivityOut=reflectivityBlock\\(\\s*(?:uniforms\\.)?vReflectivityColor', 'reflectivityOut=reflectivityBlock(\nsss_reflectivity',
  ],
  sss_sheen: ['!sheenOut=sheenBlock\\(\\s*(?:uniforms\\.)?vSheenColor', 'sheenOut=sheenBlock(\nsss_sheen'],
  sss_sheen_roughness: ['!,(?:uniforms\\.)?vSheenRoughness(?!\\w|:)', ',sss_sheen_roughness'],
  sss_coat: ['!,viewDirectionW\\s*,(?:uniforms\\.)?vClearCoatParams', ',viewDirectionW\n,sss_coat'],
};

/** A light of Babylon's fragment shader behind its shadow: the text of the shadow, and the number of the light. */
const BEHIND_SHADOW = '!(#ifdef SHADOW(\\d+)\\s(?:(?!#ifdef SHADOW\\d+\\s)[^])*?)aggShadow\\s*\\+=\\s*shadow;';

/**
 * Babylon's text of a light's shadow a second time, read where the light entered the body, in GLSL and in WGSL: the names of
 * what it reads stand for values of this place. TO_LIGHT is Babylon's way into the shadow map, from its vertex shader.
 */
const SHADOWS = [`{
vec4 worldPos = vec4(sss_entry, 1.0);
vec3 vPositionW = sss_entry;
float shadow = 1.0;
#ifdef SHADOWCSM$2
vec4 vPositionFromLight$2[SHADOWCSMNUM_CASCADES$2];
float vDepthMetric$2[SHADOWCSMNUM_CASCADES$2];
#else
vec4 vPositionFromLight$2;
float vDepthMetric$2;
#endif
TO_LIGHT
$1
sss_shadow = shadow;
}`, `{
let sss_inputs = fragmentInputs;
let worldPos = vec4f(sss_entry, 1.0);
var shadow = 1.0;
fragmentInputs.vPositionW = sss_entry;
TO_LIGHT
$1
sss_shadow = shadow;
fragmentInputs = sss_inputs;
}`];

const TO_LIGHT = 'vPositionFromLight\\{X\\}[^;]*=[^;]*worldPos';
/** Babylon's way from `worldPos` into a shadow map. A cascade is that of the seen point: the light's way has one place in it. */
const wayToLight = (vertexText) => vertexText
  .replace(/[\w.]*vPositionFromCamera\{X\}\s*=[^;]*;/g, '').replaceAll('vertexOutputs.', 'fragmentInputs.').replaceAll('{X}', '$2');

/** A rectangle of light is four lights: the values of Babylon's variables for each. In GLSL and in WGSL. */
const AREA_WORDS = [
  { area: 'mat3 area', way: 'vec4 way', index: 'int index', mat3: 'mat3', place: 'vPositionW' },
  { area: 'var area', way: 'var way', index: 'var index', mat3: 'mat3x3f', place: 'fragmentInputs.vPositionW' },
];
const areaLights = ({ area, passes }, translucency, words) => `{
${words.area} = ${words.mat3}(light$2.vLightData.xyz - ${words.place}, light$2.vLightWidth.xyz, light$2.vLightHeight.xyz);
for (${words.index} = 0; index < 4; index++) {
${words.way} = ${area.towards}(index, ${spreadOf(passes)}, area);
preInfo.L = way.xyz;
preInfo.lightDistance = 1.0 / way.w;
preInfo.attenuation = max(${area.light}(area, way), 0.0);
sss_lights += sss_light_color * preInfo.attenuation * ${translucency};
}
}`;

/** The places of the light that comes through. */
const lightPlaces = (description, { translucency, entry }, language) => ({
  [BEHIND_SHADOW]: `$1
#if defined(LIGHTMAP) && defined(LIGHTMAPEXCLUDED$2) && defined(LIGHTMAPNOSPECULAR$2)
#elif defined(DIRLIGHT$2) || defined(POINTLIGHT$2) || defined(SPOTLIGHT$2)
sss_light_color = diffuse$2.rgb;
#ifdef DIRLIGHT$2
sss_light_nearness = 0.0;
#else
sss_light_nearness = 1.0;
#endif
sss_shadow = 1.0;
#ifdef SHADOW$2
${entry}
${SHADOWS[language]}
#endif
sss_lights += sss_light_color * preInfo.attenuation * sss_shadow * ${translucency};
#elif defined(AREALIGHT$2) && defined(AREALIGHTUSED) && defined(AREALIGHTSUPPORTED)
sss_light_color = diffuse$2.rgb;
sss_light_nearness = 1.0;
${areaLights(description, translucency, AREA_WORDS[language])}
#endif
aggShadow+=shadow;
`,
  CUSTOM_FRAGMENT_BEFORE_FINALCOLORCOMPOSITION: `
#ifndef UNLIT
finalDiffuse += sss_lights * ${['', 'uniforms.'][language]}vLightingIntensity.x / 3.14159265;
#endif
`,
});

const readsSurroundings = ({ begin }) => begin.includes('sss_surroundings(');

/** What goes into Babylon's shaders in one language: place → text. */
function placesOf(description, language) {
  const { textures, varyings, variables, shells } = description;
  const { functions, vertex, begin, places } = shells[language];
  const { texture, varying, variable } = DECLARATIONS[language];
  const samplers = Object.fromEntries(Object.values(textures).map(({ name, type }) => [name, type]));
  const passed = declared(varying, varyings);
  const around = readsSurroundings(shells[language]) ? SURROUNDINGS[language] : '';
  const lights = shells[language].translucency ? lightPlaces(description, shells[language], language) : {};
  const fragment = {
    CUSTOM_FRAGMENT_DEFINITIONS: declared(texture, samplers) + passed + around + functions + declared(variable, variables),
    CUSTOM_FRAGMENT_MAIN_BEGIN: begin,
    ...Object.fromEntries(Object.keys(variables).filter((name) => name in ARGUMENTS).map((name) => ARGUMENTS[name])),
    ...lights,
  };
  for (const [place, text] of Object.entries(places)) fragment[place] = (lights[place] ?? '') + text;
  return {
    vertex: withoutComments({ CUSTOM_VERTEX_DEFINITIONS: passed, CUSTOM_VERTEX_MAIN_END: vertex }),
    fragment: withoutComments(fragment),
  };
}

/** Places with their texts. Babylon takes shaders apart at semicolons, also in comments. */
const withoutComments = (places) => Object.fromEntries(
  Object.entries(places).map(([place, text]) => [place, text.replace(/\/\/.*$/gm, '')]),
);

/** A value in the space of a body, for the world: a matrix takes positions of the world, a length is one there. */
const placedValue = (value, world) => (
  value instanceof Matrix ? Matrix.Invert(world).multiply(value) : value * Math.cbrt(Math.abs(world.determinant()))
);

/** The plug-in of a material. */
function pluginClass(description, properties) {
  const { moves, takesLight } = properties;
  const { name: materialName, parameters, textures, shells, passes } = description;
  const code = [0, 1].map((language) => placesOf(description, language));
  // Babylon keeps one program for each name of a plug-in
  const key = `Sssgen_${materialName}_${Properties.hashOf(JSON.stringify(code))}`;
  const uniforms = Object.values(parameters).map(({ name, type }) => [name, uniformType(type)]);
  const placed = Object.keys(parameters).filter((property) => parameters[property].placed);
  if (moves) uniforms.push(['sss_time', 'float']);
  if (takesLight) uniforms.push(['sss_light_place', 'vec4'], ['sss_light_radiance', 'vec3']);
  const around = readsSurroundings(shells[0]);
  if (around) uniforms.push(...SKY.map((name) => [name, 'vec4']));
  if (shells[0].entry) uniforms.push(['sss_body_min', 'vec3'], ['sss_body_max', 'vec3']);

  return class extends MaterialPluginBase {
    /** @type {Passes | undefined} */
    #passes;

    /** @param {(property: string) => any} given the texture that the page has set @param {Responses} responses */
    constructor(material, given, responses) {
      super(material, key, 200);
      this.given = given;
      this.responses = responses;
      if (passes) this.#passes = new Passes(material, passes, (property) => Boolean(given(property)), responses);
      this.doNotSerialize = true;
      this.registerForExtraEvents = true; // calls hardBindForSubMesh and fillRenderTargetTextures
      this._enable(true);
    }

    getClassName() {
      return key;
    }

    isCompatible() {
      return true;
    }

    getUniforms() {
      return {
        ubo: uniforms.map(([name, type]) => ({ name, size: SIZES[type], type })),
        fragment: uniforms.map(([name, type]) => `uniform ${type} ${name};`).join('\n'),
      };
    }

    getSamplers(samplers) {
      samplers.push(...Object.values(textures).map(({ name }) => name));
    }

    getCustomCode(stage, language) {
      const places = code[language][stage];
      const { pbrPixelShader } = ShaderStore.GetShadersStore(language);
      if (stage === 'vertex' || !pbrPixelShader) return places;
      const { lightFragment = '', shadowsVertex = '' } = ShaderStore.GetIncludesShadersStore(language);
      const need = (sought, text) => {
        if (!new RegExp(sought).test(text)) throw new Error(`${materialName}: this version of Babylon.js has no ${sought}`);
      };
      const whole = pbrPixelShader + lightFragment.replaceAll('{X}', '0');
      for (const place of Object.keys(places)) if (place.startsWith('!')) need(place.slice(1), whole); // without a name in Babylon
      if (!(BEHIND_SHADOW in places)) return places;
      need(TO_LIGHT, shadowsVertex);
      return { ...places, [BEHIND_SHADOW]: places[BEHIND_SHADOW].replace('TO_LIGHT', () => wayToLight(shadowsVertex)) };
    }

    prepareDefinesBeforeAttributes(defines) {
      defines._needNormals = true;
      defines._needUVs = true;
    }

    getActiveTextures(active) {
      active.push(...this.#used());
    }

    hasTexture(texture) {
      return this.#used().includes(texture);
    }

    isReadyForSubMesh() {
      return this.#used().every((texture) => texture.isReadyOrNotBlocking());
    }

    hasRenderTargetTextures() {
      return Boolean(passes);
    }

    fillRenderTargetTextures(targets) {
      if (this.#passes?.properties.length) targets.push(this.#passes);
    }

    dispose(forceDisposeTextures) {
      this.#passes?.dispose();
      if (forceDisposeTextures) this.#used().forEach((texture) => texture.dispose());
    }

    #used() {
      return Object.keys(textures).map((property) => this._material[property]).filter((texture) => texture);
    }

    /** Babylon calls this for each body, bindForSubMesh for the first of those that have the material. */
    hardBindForSubMesh(buffer, scene, engine, subMesh) {
      const mesh = subMesh.getMesh(), drawn = this.#passes?.valuesOf(mesh);
      for (const property of this.#passes?.properties ?? []) this.#write(buffer, property, drawn[property]);
      for (const property of placed) this.#write(buffer, property, placedValue(this._material[property], mesh.getWorldMatrix()));
      if (around) skyOf(mesh).forEach((numbers, channel) => writeNumbers(buffer, SKY[channel], 'vec4', numbers));
      properties.checkTextures(this.given, (texture) => !texture.getTextureMatrix().isIdentityAs3x2(), this.responses);
      if (!shells[0].entry) return;
      const { minimum, maximum } = mesh.getRawBoundingInfo().boundingBox; // without the places of thin instances
      buffer.updateVector3('sss_body_min', minimum);
      buffer.updateVector3('sss_body_max', maximum);
    }

    bindForSubMesh(buffer) {
      const material = /** @type {any} */ (this._material), ofBody = [...(this.#passes?.properties ?? []), ...placed];
      for (const property of [...Object.keys(parameters), ...Object.keys(textures)]) {
        if (!ofBody.includes(property)) this.#write(buffer, property);
      }
      if (moves) writeNumbers(buffer, 'sss_time', 'float', [material.time ?? performance.now() / 1000]);
      if (takesLight) {
        const [place, radiance] = lightOf(material.light);
        writeNumbers(buffer, 'sss_light_place', 'vec4', place);
        writeNumbers(buffer, 'sss_light_radiance', 'vec3', radiance);
      }
    }

    #write(buffer, property, value = this._material[property]) {
      if (property in textures) buffer.setTexture(textures[property].name, value);
      else writeNumbers(buffer, parameters[property].name, parameters[property].type, numbersOf(value));
    }
  };
}

function writeNumbers(buffer, name, type, numbers) {
  const size = SIZES[uniformType(type)];
  if (size === 16) buffer.updateMatrices(name, Float32Array.from(numbers));
  else buffer[`updateFloat${size === 1 ? '' : size}`](name, ...numbers);
}

/** The numbers of a property: a number, a boolean, or one of Babylon's vectors, colours and matrices. */
const numbersOf = (value) => (typeof value === 'object' ? [...value.asArray()].map(Number) : [Number(value)]);

/**
 * The first value of a parameter, as a user gets it.
 * @param {import('./values.js').Parameter} declared
 */
function startOf({ type, default: start, color }) {
  if (!Array.isArray(start)) return start;
  if (type.startsWith('mat')) return matrix(start);
  return (color ? Color3 : { 2: Vector2, 3: Vector3, 4: Vector4 }[start.length]).FromArray(start);
}

/** A matrix of 2, 3 or 4 columns as one of Babylon. */
function matrix(numbers) {
  const side = Math.sqrt(numbers.length);
  return Matrix.FromArray(Array.from({ length: 16 }, (_, i) => (i % 4 < side && i >> 2 < side ? numbers[(i >> 2) * side + (i % 4)] : +(i % 5 === 0))));
}

const HALVES = { 0: 0, 0.5: 0x3800, 1: 0x3c00 };
const RGBA = 5, LINEAR = 2, HALF_FLOAT = 2;

/** A texture of one texel, in half floats, which every device filters. */
function texel({ type, default: name }, scene) {
  const data = new Uint16Array(TEXELS[name].map((value) => HALVES[value]));
  if (type === 'samplerCube') return new RawCubeTexture(scene, Array(6).fill(data), 1, RGBA, HALF_FLOAT, false, false, LINEAR);
  if (type === 'sampler2D') return new RawTexture(data, 1, 1, RGBA, scene, false, false, LINEAR, HALF_FLOAT);
  const Layered = type === 'sampler3D' ? RawTexture3D : RawTexture2DArray;
  return new Layered(data, 1, 1, 1, RGBA, scene, false, false, LINEAR, HALF_FLOAT);
}

/**
 * The class of a material: PBRMaterial with the material's properties and its plug-in.
 * @param {Description} description
 */
export function materialClass(description) {
  const { name: materialName, lit, twoSided, alphaMode, fields = [], parameters, textures } = description;
  const properties = new Properties(description, 'PBRMaterial');
  const { moves, takesLight } = properties;
  const Plugin = pluginClass(description, properties);

  return class extends PBRMaterial {
    #values = Object.fromEntries(Object.entries(parameters).map(([property, declared]) => [property, startOf(declared)]));
    #given = {};
    #texels = {};
    /** What the page has set for volumes that are computed. */
    #responses = new Responses(description.passes ?? []);

    constructor(values = {}, scene = EngineStore.LastCreatedScene) {
      if (!scene) throw new TypeError(`${materialName}: there is no scene: create one first, or give it as the second argument`);
      super(materialName, scene);
      this.metallic = 0;
      this.roughness = 1;
      if (!lit) this.unlit = true;
      if (fields.includes('clearcoat')) this.clearCoat.isEnabled = true; // the surface has its weight
      if (fields.includes('sheen_color')) {
        this.sheen.isEnabled = true;
        this.sheen.roughness = 0; // apart from the intensity
        this.sheen.albedoScaling = true; // what the fibres reflect does not reach the surface below
      }
      if (twoSided) this.backFaceCulling = false;
      if (twoSided) this.twoSidedLighting = true;
      if (alphaMode === 'mask') this.transparencyMode = PBRMaterial.PBRMATERIAL_ALPHATEST;
      if (alphaMode === 'mask') this.alphaCutOff = 0.5;
      if (alphaMode === 'blend') this.transparencyMode = PBRMaterial.PBRMATERIAL_ALPHABLEND;
      /** In seconds; null: the page's clock. */
      if (moves) this.time = null;
      /** One of Babylon's lights, which lights this unlit material; null: none. */
      if (takesLight) this.light = null;
      new Plugin(this, (property) => this.#given[property], this.#responses);
      properties.checkNames(this, values);
      Object.assign(this, values);
    }

    static {
      for (const property of Object.keys(parameters)) {
        properties.define(this.prototype, property, {
          get() { return this.#values[property]; },
          set(value) { this.#setParameter(property, value); },
        });
      }
      for (const property of Object.keys(textures)) {
        properties.define(this.prototype, property, {
          get() { return this.#given[property] ?? this.#texel(property); },
          set(value) { this.#setTexture(property, value); },
        });
      }
    }

    #setParameter(property, value) {
      const old = this.#values[property];
      const isColor = old instanceof Color3;
      const color = isColor && /^#[0-9a-f]{6}$/i.test(value) && Color3.FromHexString(value).toLinearSpace();
      const numbers = properties.numbers(property, color || value, isColor ? ", a Color3, or a colour such as '#3070ff'" : '');
      if (typeof old !== 'object') this.#values[property] = typeof old === 'boolean' ? Boolean(numbers[0]) : numbers[0];
      else if (old instanceof Matrix) this.#values[property] = matrix(numbers);
      else old.fromArray(numbers);
    }

    #setTexture(property, value) {
      const { color } = textures[property];
      if (this.#responses.take(property, value, (name, numbers) => name in parameters && this.#setParameter(name, numbers))) value = null;
      const taken = value == null || typeof value === 'string' || value.getInternalTexture;
      if (!taken) properties.refuse(property, 'a texture, the URL of one, or null', value);
      if (typeof value === 'string') value = new Texture(value, this.getScene(), { useSRGBBuffer: color });
      if (value?.isCube || value?.getInternalTexture()) {
        properties.checkKind(property, { cube: value.isCube, volume: value.is3D, layers: value.is2DArray });
      }
      if (color && value?.gammaSpace && value.textureType === 0) {
        console.warn(`${materialName}: ${property} has colours in sRGB: create it with { useSRGBBuffer: true }, or set its URL`);
      }
      this.#given[property] = value;
      this.markAsDirty(PBRMaterial.TextureDirtyFlag);
    }

    #texel(property) {
      if (!(property in this.#texels)) {
        this.#texels[property] = null; // Babylon asks for all textures while one is created
        this.#texels[property] = texel(textures[property], this.getScene());
      }
      return this.#texels[property];
    }

    needAlphaTesting() {
      return super.needAlphaTesting() || this.transparencyMode === PBRMaterial.PBRMATERIAL_ALPHATEST;
    }

    needAlphaBlending() {
      return super.needAlphaBlending() || this.transparencyMode === PBRMaterial.PBRMATERIAL_ALPHABLEND;
    }

    clone(name, cloneTexturesOnlyOnce = true, rootUrl = '') {
      const Own = /** @type {any} */ (this.constructor);
      const copy = SerializationHelper.Clone(() => new Own({}, this.getScene()), this, { cloneTexturesOnlyOnce });
      Object.assign(copy, { id: name, name });
      this.stencil.copyTo(copy.stencil);
      this._clonePlugins(copy, rootUrl);
      Object.assign(copy, this.#values, this.#given, Object.fromEntries(this.#responses), moves && { time: this.time }, takesLight && { light: this.light });
      return copy;
    }

    dispose(forceDisposeEffect, forceDisposeTextures) {
      super.dispose(forceDisposeEffect, forceDisposeTextures);
      Object.values(this.#texels).forEach((texture) => texture.dispose());
    }
  };
}
