// The way of a material's text into PlayCanvas's chunks: PlayCanvas's own text stays, and the material's is added.

import * as pc from 'playcanvas';
import { spreadOf } from './frame_passes.js';

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
function declarations({ parameters, textures, shells }, { moves, takesLight }, gpu) {
  const uniforms = Object.values(parameters).map(({ type, name }) => [type, name]);
  if (moves) uniforms.push(['float', 'sss_time']);
  if (takesLight) uniforms.push(['vec4', 'sss_light_place'], ['vec3', 'sss_light_radiance']);
  if (shells[0].entry) uniforms.push(['vec3', 'sss_body_min'], ['vec3', 'sss_body_max']);
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
const LIGHT = { sss_L: 'vec3', sss_light_color: 'vec3', sss_light_nearness: 'float', sss_light_sum: 'vec3', sss_shadow: 'float' };

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
 * @returns {[string, RegExp, string | ((chunk: string) => string), string][]}
 */
function changes(description, gpu) {
  const { lit, shells, area } = description;
  const own = shells[Number(gpu)];
  const { front = '', opacity = '', ambient = '' } = own.places;
  const { head } = LANGUAGES[Number(gpu)];
  return [
    ['stdFrontEndPS', /evaluateFrontend/, 'sss_engine_front', `
${own.begin.includes('sss_surroundings(') ? surroundings(gpu, head) : ''}
${head('void evaluateFrontend()')} {
${lit ? 'sss_light_sum = vec3(0.0);' : ''}
${own.entry ? 'sss_shadow_place = vPositionW;' : ''}
${own.begin}
  sss_engine_front();
#ifdef FORWARD_PASS
${front}
#endif
}
${lit ? lightFunctions(own, area, gpu, head) : ''}`],
    ['opacityPS', /getOpacity/, 'sss_engine_opacity', `
${head('void getOpacity()')} {
  sss_engine_opacity();
${opacity}
}
`],
    ['combinePS', /combineColor/, 'sss_engine_combine', `
${lit && !gpu ? ambientDeclaration('SSS_OWN_LIGHT') : ''}
${head('vec3 combineColor(vec3 albedo, vec3 sheenSpecularity, float clearcoatSpecularity)')} {
${lit ? lightSum(ambient) : 'return vec3(0.0);'}
}
`],
    ...(lit ? lightChanges(description, gpu, head) : []),
  ];
}

/** GLSL needs it before the function is called. */
const ambientDeclaration = (where) => `
#if defined(${where}) && defined(LIT_ADD_AMBIENT)
void addAmbient(vec3 worldNormal);
#endif`;

/** The light of the surroundings on a white matte surface that faces a direction of the world, as PlayCanvas adds it. */
const surroundings = (gpu, head) => `
${gpu ? '' : ambientDeclaration('FORWARD_PASS')}
${head('vec3 sss_surroundings(vec3 direction)')} {
#if defined(FORWARD_PASS) && defined(LIT_ADD_AMBIENT)
dDiffuseLight = ${gpu ? 'vec3f' : 'vec3'}(0.0);
addAmbient(direction);
return dDiffuseLight;
#else
return ${gpu ? 'vec3f' : 'vec3'}(0.0);
#endif
}
`;

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

/**
 * One of PlayCanvas's lights: what comes through, of which `sss_shadow` is left, and what the material reflects itself. An
 * area of light, given by three corners, is four lights; it shines to both sides.
 */
const lightFunctions = ({ translucency, entry, lighting }, area, gpu, head) => `
${head('void sss_set_light(vec3 L, vec3 color, float nearness)')} {
  sss_L = L;
  sss_light_color = color;
  sss_light_nearness = nearness;
  sss_shadow = 1.0;
${entry ?? ''}
}
${head('void sss_light_through()')} {
${translucency ? `sss_light_sum += sss_light_color * sss_shadow * ${translucency};` : ''}
}
${area ? `${head('void sss_area_through(vec3 corner, vec3 next, vec3 last, float spread, float strength)')} {
  ${gpu ? 'let area = mat3x3f' : 'mat3 area = mat3'}(0.5 * (next + last) - vPositionW, 0.5 * (corner - next), 0.5 * (last - corner));
  ${gpu ? 'let' : 'vec3'} color = sss_light_color * strength;
  for (${gpu ? 'var' : 'int'} index = 0; index < 4; index++) {
    ${gpu ? 'let' : 'vec4'} way = ${area.towards}(index, spread, area);
    sss_L = way.xyz;
    sss_light_color = color * abs(${area.light}(area, way));
    sss_light_nearness = way.w;
    sss_light_through();
  }
}` : ''}
#ifdef SSS_OWN_LIGHT
${head('void sss_light_reflected(vec3 color)')} {
  sss_light_color = color;
  sss_light_sum += ${lighting};
}
#endif
`;

/** Where PlayCanvas's text of a light's shadow begins in its chunk, with this text: it multiplies the light by it. */
const SHADOW = /(?=(#ifdef LIGHT\{i\}CASTSHADOW[^]*?dAtten\b[^;]*shadow;))/;
/** Of a light in a cluster: this text is a block. */
const CLUSTERED_SHADOW = /(?=if \(light\.shadowIntensity > 0\.0 \|\| light\.cookieIntensity > 0\.0\) \{)/;

/** The block of a text that begins where `head` matches. */
function blockOf(text, head) {
  const start = text.search(head);
  let depth = 0;
  for (let at = text.indexOf('{', start); at < text.length; at++) {
    depth += { '{': 1, '}': -1 }[text[at]] ?? 0;
    if (!depth) return text.slice(start, at + 1);
  }
  return '';
}

/**
 * PlayCanvas's text of a light's shadow a second time, read where the light entered the body: without an offset along the
 * normal, which is that of the seen side. It multiplies `attenuation`, which is 1 before it.
 */
const shadowOfEntry = (text, attenuation) => `
${attenuation} = 1.0;
sss_shadow_place = sss_entry;
${text}
sss_shadow_place = vPositionW;
sss_shadow = ${attenuation};`;

/**
 * What comes through of a light with an area, by its shape: PlayCanvas's light of 1 is the radiance 16, and that of a
 * sphere falls in a way of its own.
 */
const areaShapes = ({ area, passes }) => {
  const corners = [0, 1, 3].map((corner) => `dLTCCoords.coord${corner}`);
  const through = (strength, spread) => (area ? `sss_area_through(${corners.join(', ')}, ${spreadOf(passes, spread)}, ${strength});` : '');
  return {
    rectangle: through('5.09295818'), // 16 / pi
    disk: through('4.0', '0.5'), // its share of a rectangle is pi / 4
    sphere: `
sss_light_color *= 16.0 * dSphereRadius / (dot(lightDirW, lightDirW) + dSphereRadius);
sss_light_through();`,
  };
};

/**
 * Those of a lit material.
 * @returns {[string, RegExp, string | ((chunk: string) => string), string][]}
 */
const lightChanges = (description, gpu, head) => {
  const { entry } = description.shells[Number(gpu)], areas = areaShapes(description);
  const local = (type, name, value) => `${gpu ? 'var' : type} ${name} = ${value};`;
  const listed = (chunk) => !entry ? '' : `
#ifdef LIGHT{i}CASTSHADOW
{
${local('vec3', 'sss_normal', 'dVertexNormalW')}
${local('float', 'sss_arriving', 'dAtten')}
dVertexNormalW = vec3(0.0);
#if LIGHT{i}TYPE != DIRECTIONAL
${local('vec3', 'lightDirW', `sss_entry - ${gpu ? 'uniform.' : ''}light{i}_position`)}
#endif
${shadowOfEntry(`${chunk.match(SHADOW)[1]}\n#endif`, 'dAtten')}
dAtten = sss_arriving;
dVertexNormalW = sss_normal;
}
#endif`;
  const clustered = (chunk) => !entry ? '' : `
#ifdef CLUSTER_SHADOWS
if (light.shadowIntensity > 0.0) {
${local('vec3', 'geometricNormal', 'vec3(0.0)')}
${local('vec3', 'cookieAttenuation', 'vec3(1.0)')}
${local('float', 'falloffAttenuation', '1.0')}
${shadowOfEntry(blockOf(chunk, CLUSTERED_SHADOW), 'falloffAttenuation')}
}
#endif`;
  return [
    ['lightDiffuseLambertPS', /getLightDiffuse/, 'sss_engine_lambert', `
${head('float getLightDiffuse(vec3 worldNormal, vec3 viewDir, vec3 lightDirNorm)')} {
#ifdef SSS_OWN_LIGHT
  return 1.0;
#else
  return sss_engine_lambert(worldNormal, viewDir, lightDirNorm);
#endif
}
`],
    ...(entry ? SHADOW_PLACES : []),
    ['lightFunctionLightPS', /(?=#if LIGHT\{i\}SHAPE != PUNCTUAL\s+#if LIGHT\{i\}TYPE == DIRECTIONAL)/, (chunk) => `
#if LIGHT{i}TYPE == DIRECTIONAL
sss_set_light(-dLightDirNormW, lightColor * dAtten, 0.0);
#else
sss_set_light(-dLightDirNormW, lightColor * dAtten, 1.0 / max(length(lightDirW), 0.01));
#endif
${listed(chunk)}
#if LIGHT{i}TYPE == DIRECTIONAL || LIGHT{i}SHAPE == PUNCTUAL
sss_light_through();
#elif LIGHT{i}SHAPE == RECT
${areas.rectangle}
#elif LIGHT{i}SHAPE == DISK
${areas.disk}
#else
${areas.sphere}
#endif
`, ''],
    ['lightFunctionLightPS', /(?=#ifdef LIGHT\{i\}AFFECT_SPECULARITY)/, `
#if defined(SSS_OWN_LIGHT) && LIGHT{i}SHAPE == PUNCTUAL
sss_light_reflected(lightColor * dAtten);
#endif
`, ''],
    ['clusteredLightPS', /(?<=if \(falloffAttenuation > 0\.00001\) \{)/, (chunk) => `
${local('float', 'sss_arriving', 'falloffAttenuation')}
if (light.isSpot) {
  ${gpu ? 'let' : 'ClusterLightSpotData'} spot = decodeClusterLightSpot();
  sss_arriving *= getSpotEffect(light.direction, spot.innerConeAngleCos, spot.outerConeAngleCos, lightDirNormW);
}
sss_set_light(-lightDirNormW, light.color * sss_arriving, 1.0 / max(length(lightDirW), 0.01));
${clustered(chunk)}
#ifdef CLUSTER_AREALIGHTS
if (light.shape == {LIGHTSHAPE_RECT}) {
${areas.rectangle}
} else if (light.shape == {LIGHTSHAPE_DISK}) {
${areas.disk}
} else if (light.shape == {LIGHTSHAPE_SPHERE}) {
${areas.sphere}
} else
#endif
{
sss_light_through();
}
`, ''],
    ['clusteredLightPS', /(?=dAtten = falloffAttenuation;)/, `
#ifdef SSS_OWN_LIGHT
if (light.shape == {LIGHTSHAPE_PUNCTUAL}) { sss_light_reflected(light.color * cookieAttenuation * falloffAttenuation); }
#endif
`, ''],
  ];
};

/**
 * PlayCanvas reads shadows at a place that the material can move; the last two only say what must be there.
 * @type {[string, RegExp, string, string][]}
 */
const SHADOW_PLACES = [
  ['lightFunctionShadowPS', /\bvPositionW\b/g, 'sss_shadow_place', ''],
  ['clusteredLightShadowsPS', /\bvPositionW\b/g, 'sss_shadow_place', ''],
  ['lightFunctionLightPS', SHADOW, '', ''],
  ['clusteredLightPS', CLUSTERED_SHADOW, '', ''],
];

/** Gives a material its chunks. */
export function setChunks(material, device, description, properties) {
  const gpu = device.isWebGPU;
  const language = gpu ? pc.SHADERLANGUAGE_WGSL : pc.SHADERLANGUAGE_GLSL;
  const engine = pc.ShaderChunks.get(device, language);
  const chunks = material.getShaderChunks(language);
  for (const [name, text] of additions(description, properties, gpu)) chunks.set(name, (engine.get(name) ?? '') + text);
  for (const [name, sought, instead, after] of changes(description, gpu)) {
    const chunk = chunks.get(name) ?? engine.get(name) ?? '';
    if (chunk.search(sought) < 0) throw new Error(`${description.name}: this version of PlayCanvas has no ${sought.source} in its chunk ${name}`);
    const text = typeof instead === 'string' ? instead : instead(chunk);
    chunks.set(name, chunk.replace(sought, () => text) + after);
  }
}
