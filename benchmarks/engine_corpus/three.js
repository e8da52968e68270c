// three.js: each material with lights, maps and geometry in variants; the passes and shaders of its examples.

import * as THREE from 'three';
import * as passes from 'three_passes';
import * as shaders from 'three_shaders';
import * as objects from 'three_objects';
import { EffectComposer } from 'three/examples/jsm/postprocessing/EffectComposer.js';
import { canvas, run } from './pages_common.js';

const renderer = new THREE.WebGLRenderer({ canvas: canvas() });
const camera = new THREE.PerspectiveCamera(50, 1, 0.1, 20);
camera.position.z = 3;

const texture = (Kind = THREE.DataTexture, ...size) => {
  const [width, height, depth] = [...size, 4, 4].slice(0, 3);
  const cells = width * height * (Kind === THREE.DataTexture ? 1 : depth);
  const made = new Kind(new Uint8Array(cells * 4).fill(128), ...(Kind === THREE.DataTexture ? [width, height] : [width, height, depth]));
  made.needsUpdate = true;
  return made;
};
const faces = () => {
  const made = new THREE.CubeTexture(Array.from({ length: 6 }, () => texture()));
  made.needsUpdate = true;
  return made;
};

function geometryOf({ morph, skin, colors, tangents } = {}) {
  const geometry = new THREE.TorusKnotGeometry(0.6, 0.2, 12, 5);
  const count = geometry.attributes.position.count;
  geometry.setAttribute('uv1', geometry.attributes.uv);
  geometry.setAttribute('uv2', geometry.attributes.uv);
  if (morph) {
    geometry.morphAttributes.position = [geometry.attributes.position.clone(), geometry.attributes.normal.clone()];
    geometry.morphAttributes.normal = [geometry.attributes.normal.clone(), geometry.attributes.normal.clone()];
    if (colors) geometry.morphAttributes.color = [geometry.attributes.normal.clone(), geometry.attributes.normal.clone()];
  }
  if (skin) {
    geometry.setAttribute('skinIndex', new THREE.Uint16BufferAttribute(new Uint16Array(4 * count), 4));
    geometry.setAttribute('skinWeight', new THREE.Float32BufferAttribute(new Float32Array(4 * count).fill(0.25), 4));
  }
  if (colors) geometry.setAttribute('color', new THREE.Float32BufferAttribute(new Float32Array(colors * count).fill(1), colors));
  if (tangents) geometry.setAttribute('tangent', new THREE.Float32BufferAttribute(new Float32Array(4 * count).fill(1), 4));
  return geometry;
}

function meshOf(material, { instances, batch, skin, ...geometry } = {}) {
  const shape = geometryOf({ skin, ...geometry });
  if (batch) {
    const mesh = new THREE.BatchedMesh(2, 4000, 8000, material);
    const id = mesh.addGeometry(shape);
    mesh.setColorAt(mesh.addInstance(id), new THREE.Color(1, 0, 0));
    return mesh;
  }
  if (instances) {
    const mesh = new THREE.InstancedMesh(shape, material, 2);
    for (const index of [0, 1]) {
      mesh.setMatrixAt(index, new THREE.Matrix4());
      if (instances === 'color') mesh.setColorAt(index, new THREE.Color(1, 0, 0));
    }
    return mesh;
  }
  if (skin) {
    const mesh = new THREE.SkinnedMesh(shape, material);
    const bone = new THREE.Bone();
    mesh.add(bone);
    mesh.bind(new THREE.Skeleton([bone]));
    return mesh;
  }
  return new THREE.Mesh(shape, material);
}

const LIGHTS = {
  directional: () => new THREE.DirectionalLight(),
  point: () => new THREE.PointLight(),
  spot: () => new THREE.SpotLight(),
  map: () => Object.assign(new THREE.SpotLight(), { map: texture() }),
  hemisphere: () => new THREE.HemisphereLight(),
  area: () => new THREE.RectAreaLight(),
  probe: () => new THREE.LightProbe(),
  ambient: () => new THREE.AmbientLight(),
};

function draw(material, { lights = ['directional'], shadows, shadowType = THREE.PCFShadowMap, fog, environment, tone = THREE.NoToneMapping, geometry, object, linear } = {}) {
  const scene = new THREE.Scene();
  const mesh = object ?? meshOf(material, geometry);
  mesh.castShadow = mesh.receiveShadow = !!shadows;
  scene.add(mesh);
  for (const name of lights) {
    const light = LIGHTS[name]();
    if (light.shadow) light.castShadow = !!shadows;
    if (light.shadow && shadows) light.shadow.mapSize.set(16, 16);
    light.position.set(1, 2, 3);
    scene.add(light);
  }
  if (fog) scene.fog = fog === 'exp2' ? new THREE.FogExp2(0x888888, 0.1) : new THREE.Fog(0x888888, 1, 9);
  if (environment) scene.environment = environmentMap();
  renderer.shadowMap.enabled = !!shadows;
  renderer.shadowMap.type = shadowType;
  renderer.toneMapping = tone;
  renderer.outputColorSpace = linear ? THREE.LinearSRGBColorSpace : THREE.SRGBColorSpace;
  renderer.render(scene, camera);
}

let prefiltered;
function environmentMap() {
  if (!prefiltered) {
    const generator = new THREE.PMREMGenerator(renderer);
    const scene = new THREE.Scene();
    scene.background = new THREE.Color(0.5, 0.6, 0.7);
    prefiltered = generator.fromScene(scene, 0.04).texture;
    generator.fromEquirectangular(Object.assign(texture(THREE.DataTexture, 64, 32), { mapping: THREE.EquirectangularReflectionMapping }));
    generator.fromCubemap(faces());
  }
  return prefiltered;
}

const LIT = ['MeshLambertMaterial', 'MeshPhongMaterial', 'MeshToonMaterial', 'MeshStandardMaterial', 'MeshPhysicalMaterial'];
const UNLIT = ['MeshBasicMaterial', 'MeshNormalMaterial', 'MeshMatcapMaterial', 'MeshDepthMaterial', 'MeshDistanceMaterial', 'ShadowMaterial'];
const MAPS = [
  'map', 'alphaMap', 'aoMap', 'lightMap', 'bumpMap', 'normalMap', 'displacementMap', 'emissiveMap', 'specularMap', 'roughnessMap',
  'metalnessMap', 'gradientMap', 'matcap', 'clearcoatMap', 'clearcoatNormalMap', 'clearcoatRoughnessMap', 'sheenColorMap',
  'sheenRoughnessMap', 'transmissionMap', 'thicknessMap', 'iridescenceMap', 'iridescenceThicknessMap', 'anisotropyMap',
  'specularColorMap', 'specularIntensityMap', 'envMap',
];
const LAYERS = {
  clearcoat: { clearcoat: 1 }, sheen: { sheen: 1 }, transmission: { transmission: 1, thickness: 1 },
  dispersion: { transmission: 1, thickness: 1, dispersion: 0.2 }, iridescence: { iridescence: 1 }, anisotropy: { anisotropy: 0.5 },
  all: { clearcoat: 1, sheen: 1, transmission: 1, thickness: 1, iridescence: 1, anisotropy: 0.5, dispersion: 0.1 },
};
const ALL_LIGHTS = ['directional', 'point', 'spot', 'hemisphere', 'ambient'];

const steps = [];
const step = (name, material, options) => steps.push([name, () => draw(material(), options)]);

for (const kind of [...UNLIT, ...LIT]) {
  const plain = (more = {}) => new THREE[kind](more);
  const allMaps = () => {
    const one = plain();
    for (const name of MAPS) if (name in one && name !== 'envMap') one[name] = texture();
    for (const values of Object.values(LAYERS)) for (const [name, value] of Object.entries(values)) if (name in one) one[name] = value;
    return one;
  };
  step(kind, () => plain());
  step(`${kind} maps`, allMaps, { lights: ALL_LIGHTS });
  step(`${kind} flat, wireframe`, () => plain({ ...('flatShading' in plain() ? { flatShading: true } : {}), ...('wireframe' in plain() ? { wireframe: true } : {}) }));
  step(`${kind} both sides, alpha test`, () => Object.assign(plain({ side: THREE.DoubleSide }), { alphaTest: 0.5 }, 'map' in plain() ? { map: texture() } : {}));
  step(`${kind} alpha hash, premultiplied, dithering`, () => Object.assign(plain(), { alphaHash: true, premultipliedAlpha: true, transparent: true, dithering: true }));
  step(`${kind} instances`, () => plain(), { geometry: { instances: 'color', colors: 3 } });
  step(`${kind} batch`, () => plain(), { geometry: { batch: true } });
  step(`${kind} skin, morph`, () => plain(), { geometry: { skin: true, morph: true } });
  step(`${kind} morph with colours`, () => Object.assign(plain(), { vertexColors: true }), { geometry: { morph: true, colors: 4 } });
  step(`${kind} clipping`, () => Object.assign(plain(), { clippingPlanes: [new THREE.Plane(), new THREE.Plane()], clipIntersection: true, alphaToCoverage: true }));
  if (kind === 'MeshDepthMaterial' || kind === 'MeshDistanceMaterial') continue;
  step(`${kind} fog`, () => plain(), { fog: 'linear', tone: THREE.ACESFilmicToneMapping });
  step(`${kind} fog exp2`, () => plain(), { fog: 'exp2', tone: THREE.AgXToneMapping, linear: true });
  if ('envMap' in plain()) {
    for (const [name, map] of Object.entries({ cube: faces, prefiltered: environmentMap })) step(`${kind} ${name} environment`, () => plain({ envMap: map() }));
  }
}
for (const kind of LIT) {
  for (const name of Object.keys(LIGHTS)) step(`${kind} ${name}`, () => new THREE[kind](), { lights: [name] });
  for (const shadowType of [THREE.BasicShadowMap, THREE.PCFShadowMap, THREE.PCFSoftShadowMap, THREE.VSMShadowMap]) {
    step(`${kind} shadows ${shadowType}`, () => new THREE[kind](), { lights: [...ALL_LIGHTS, 'map'], shadows: true, shadowType });
  }
  step(`${kind} many lights`, () => new THREE[kind](), { lights: [...ALL_LIGHTS, ...ALL_LIGHTS, 'area'] });
  step(`${kind} normal map in object space`, () => new THREE[kind]({ normalMap: texture(), normalMapType: THREE.ObjectSpaceNormalMap }), { geometry: { tangents: true } });
  step(`${kind} normal map with tangents`, () => new THREE[kind]({ normalMap: texture() }), { geometry: { tangents: true, skin: true } });
}
for (const name of MAPS) {
  for (const kind of [...LIT, ...UNLIT]) {
    if (name !== 'envMap' && name in new THREE[kind]()) {
      const own = Object.values(LAYERS).find((values) => name.startsWith(Object.keys(values)[0])) ?? {};
      step(`${kind} ${name}`, () => Object.assign(new THREE[kind]({ [name]: texture() }), kind === 'MeshPhysicalMaterial' ? own : {}));
    }
  }
}
for (const [name, values] of Object.entries(LAYERS)) {
  step(`physical ${name}`, () => new THREE.MeshPhysicalMaterial(values), { lights: ALL_LIGHTS, environment: true });
  step(`physical ${name}, area lights`, () => new THREE.MeshPhysicalMaterial({ ...values, side: THREE.DoubleSide }), { lights: ['area', 'point'], shadows: true });
}
for (const tone of ['Linear', 'Reinhard', 'Cineon', 'ACESFilmic', 'AgX', 'Neutral', 'Custom']) {
  step(`tone mapping ${tone}`, () => new THREE.MeshStandardMaterial(), { tone: THREE[`${tone}ToneMapping`] });
}
const POINTS = () => geometryOf({ colors: 4 });
for (const [name, object] of Object.entries({
  points: () => new THREE.Points(POINTS(), new THREE.PointsMaterial({ vertexColors: true })),
  'points with maps': () => new THREE.Points(POINTS(), new THREE.PointsMaterial({ map: texture(), alphaMap: texture(), sizeAttenuation: false })),
  sprite: () => new THREE.Sprite(new THREE.SpriteMaterial({ map: texture(), alphaMap: texture(), rotation: 1 })),
  'sprite of fixed size': () => new THREE.Sprite(new THREE.SpriteMaterial({ sizeAttenuation: false })),
  lines: () => new THREE.Line(POINTS(), new THREE.LineBasicMaterial({ vertexColors: true })),
  dashes: () => new THREE.LineSegments(POINTS(), new THREE.LineDashedMaterial()).computeLineDistances(),
})) {
  steps.push([name, () => draw(null, { object: object(), fog: 'linear' })]);
}
for (const [name, background] of Object.entries({
  'cube background': faces, 'flat background': texture,
  'equirectangular background': () => Object.assign(texture(), { mapping: THREE.EquirectangularReflectionMapping }),
  'prefiltered background': environmentMap,
})) {
  steps.push([name, () => renderer.render(Object.assign(new THREE.Scene(), { background: background(), backgroundBlurriness: name.startsWith('pre') ? 0.3 : 0 }), camera)]);
}

// The shaders of the examples, as materials, and the passes with their own shaders.
const isShader = (one) => one && typeof one === 'object' && one.vertexShader && one.fragmentShader;
for (const [name, shader] of Object.entries(shaders).flatMap(([, module]) => Object.entries(module))) {
  if (!isShader(shader)) continue;
  const { uniforms = {}, vertexShader, fragmentShader, defines = {} } = shader;
  step(`shader ${name}`, () => new THREE.ShaderMaterial({ name: shader.name || name, uniforms: THREE.UniformsUtils.clone(uniforms), vertexShader, fragmentShader, defines: { ...defines } }), { lights: ALL_LIGHTS });
}

const scene = () => new THREE.Scene().add(meshOf(new THREE.MeshStandardMaterial()), LIGHTS.directional());
const size = new THREE.Vector2(32, 32);
const PASSES = {
  AfterimagePass: () => [], BloomPass: () => [], DotScreenPass: () => [], FilmPass: () => [], GlitchPass: () => [], FXAAPass: () => [],
  HalftonePass: () => [{}], OutputPass: () => [], SMAAPass: () => [], TexturePass: () => [texture()],
  BokehPass: () => [scene(), camera, {}], GTAOPass: () => [scene(), camera, 32, 32], SAOPass: () => [scene(), camera],
  SSAOPass: () => [scene(), camera, 32, 32], SSAARenderPass: () => [scene(), camera], TAARenderPass: () => [scene(), camera],
  OutlinePass: () => [size, scene(), camera, []], UnrealBloomPass: () => [size, 1, 1, 0], RenderPixelatedPass: () => [4, scene(), camera],
  RenderTransitionPass: () => [scene(), camera, scene(), camera], CubeTexturePass: () => [camera, faces()], LUTPass: () => [{ lut: texture(THREE.Data3DTexture) }],
  SSRPass: () => [{ renderer, scene: scene(), camera, width: 32, height: 32, selects: [], groundReflector: null }],
};
for (const [name, values] of Object.entries(PASSES)) {
  for (const tone of name === 'OutputPass' ? ['Reinhard', 'ACESFilmic', 'AgX', 'Neutral', 'Cineon', 'Linear', 'No'] : ['No']) {
    steps.push([`pass ${name} ${tone}`, () => {
      renderer.toneMapping = THREE[`${tone}ToneMapping`];
      const composer = new EffectComposer(renderer);
      const Pass = Object.values(passes).find((module) => module[name])[name];
      const pass = new Pass(...values());
      if (name === 'OutlinePass') {
        const one = meshOf(new THREE.MeshBasicMaterial());
        pass.renderScene.add(one);
        pass.selectedObjects = [one];
      }
      composer.addPass(new (passes.RenderPass.RenderPass)(scene(), camera));
      composer.addPass(pass);
      composer.addPass(new (passes.OutputPass.OutputPass)());
      composer.render();
      composer.render();
    }]);
  }
}
const OBJECTS = {
  Sky: (Kind) => new Kind(), Water: (Kind) => new Kind(new THREE.PlaneGeometry(), { waterNormals: texture(), fog: true }),
  Reflector: (Kind) => new Kind(new THREE.PlaneGeometry(), {}), Refractor: (Kind) => new Kind(new THREE.PlaneGeometry(), {}),
  GroundedSkybox: (Kind) => new Kind(texture(), 1, 3),
};
for (const [name, make] of Object.entries(OBJECTS)) {
  steps.push([`object ${name}`, () => draw(null, { object: make(Object.values(objects).find((module) => module[name])[name]) })]);
}

run(steps);
