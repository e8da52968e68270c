// The scenes of Babylon.js, which fills uniform buffers. Nothing is loaded: textures and meshes are computed.

import * as B from '@babylonjs/core';

export const ENGINE = `Babylon.js ${B.Engine.Version}`;

export async function draw(name, canvas, context) {
  const engine = new B.Engine(context, false, { preserveDrawingBuffer: true, stencil: false });
  const scene = new B.Scene(engine);
  scene.clearColor = new B.Color4(0.13, 0.2, 0.27, 1);
  scene.useRightHandedSystem = true;
  const camera = new B.FreeCamera('camera', new B.Vector3(0.8, 1.2, 4.5), scene);
  camera.setTarget(B.Vector3.Zero());
  camera.fov = 0.7;
  const sun = new B.DirectionalLight('sun', new B.Vector3(-2, -3, -4), scene), sky = new B.HemisphericLight('sky', new B.Vector3(0, 1, 0), scene);
  sun.position = new B.Vector3(2, 3, 4);
  sky.intensity = 0.4;
  await SCENES[name]({ scene, camera, sun, engine, canvas });
  await scene.whenReadyAsync();
  scene.render();
  scene.dispose();
}

/** A texture of `size` texels, RGBA8, from a function of (u, v) that returns numbers from 0 to 1. */
function pattern(scene, size, texel) {
  const data = new Uint8Array(size * size * 4);
  for (let i = 0; i < size * size; i++) data.set([...texel(((i % size) + 0.5) / size, (Math.floor(i / size) + 0.5) / size).map((x) => Math.round(255 * x)), 255].slice(0, 4), 4 * i);
  return B.RawTexture.CreateRGBATexture(data, size, size, scene, true, false, B.Texture.TRILINEAR_SAMPLINGMODE);
}
const checks = (u, v) => ((Math.floor(u * 8) + Math.floor(v * 8)) % 2 ? [0.9, 0.8, 0.6] : [0.2, 0.35, 0.5]);
const waves = (u, v) => [0.5 + 0.3 * Math.sin(40 * u), 0.5 + 0.3 * Math.sin(40 * v), 0.9];
const grain = (u, v) => [0.5 + 0.5 * Math.sin(50 * u) * Math.sin(30 * v), 0.3 + 0.4 * u, 0.2 + 0.6 * v];
const mixed = (r, g, b) => new B.Color3(r, g, b);

/** A ball and a knot of the material. */
function shown(material, change = () => {}) {
  return async (stage) => {
    const { scene } = stage, it = material(scene);
    const ball = B.MeshBuilder.CreateSphere('ball', { diameter: 1.8, segments: 24 }, scene);
    const knot = B.MeshBuilder.CreateTorusKnot('knot', { radius: 0.5, tube: 0.18, radialSegments: 96, tubularSegments: 16 }, scene);
    ball.position.x = -1;
    knot.position.x = 1.1;
    ball.material = knot.material = it;
    await change({ ...stage, ball, knot, material: it });
  };
}
const standard = (parts) => (scene) => Object.assign(new B.StandardMaterial('standard', scene), typeof parts === 'function' ? parts(scene) : parts);
const pbr = (parts, change = () => {}) => (scene) => {
  const material = Object.assign(new B.PBRMaterial('pbr', scene), { metallic: 0.1, roughness: 0.5 }, typeof parts === 'function' ? parts(scene) : parts);
  change(material, scene);
  return material;
};
/** A cube map of colours that change smoothly with the direction, also from face to face. */
const surroundings = (scene) => {
  const direction = [(u, v) => [1, -v, -u], (u, v) => [-1, -v, u], (u, v) => [u, 1, v], (u, v) => [u, -1, -v], (u, v) => [u, -v, 1], (u, v) => [-u, -v, -1]];
  const faces = direction.map((of) => {
    const data = new Uint8Array(32 * 32 * 4);
    for (let i = 0; i < 1024; i++) {
      const [x, y, z] = of((i % 32) / 16 - 0.96875, (i >> 5) / 16 - 0.96875), length = Math.hypot(x, y, z);
      data.set([x, y, z].map((part) => 128 + 100 * Math.sin((3 * part) / length)), 4 * i);
      data[4 * i + 3] = 255;
    }
    return data;
  });
  return Object.assign(new B.RawCubeTexture(scene, faces, 32, B.Constants.TEXTUREFORMAT_RGBA, B.Constants.TEXTURETYPE_UNSIGNED_BYTE, true), { gammaSpace: true, lodGenerationScale: 0.8 });
};

export const SCENES = {
  standard: shown(standard({ diffuseColor: mixed(0.7, 0.4, 0.2), specularPower: 40 })),
  'standard with maps': shown(standard((scene) => ({ diffuseTexture: pattern(scene, 64, checks), bumpTexture: pattern(scene, 64, waves), specularTexture: pattern(scene, 64, grain), emissiveColor: mixed(0.05, 0, 0) }))),
  'four lights': shown(standard({ diffuseColor: mixed(0.4, 0.4, 0.4) }), ({ scene }) => {
    const lamp = new B.PointLight('lamp', new B.Vector3(-2, 1, 1.5), scene), spot = new B.SpotLight('spot', new B.Vector3(1, 3, 2), new B.Vector3(0, -3, -2), 1, 8, scene);
    lamp.diffuse = mixed(0.3, 0.5, 1);
    spot.diffuse = mixed(1, 0.6, 0.2);
  }),
  pbr: shown(pbr({ albedoColor: mixed(0.7, 0.3, 0.25) })),
  'pbr with maps': shown(pbr((scene) => ({ albedoTexture: pattern(scene, 64, checks), bumpTexture: pattern(scene, 64, waves), metallicTexture: pattern(scene, 64, grain), useRoughnessFromMetallicTextureGreen: true, useMetallnessFromMetallicTextureBlue: true }))),
  'pbr in surroundings': shown(pbr({ albedoColor: mixed(0.9, 0.8, 0.5), metallic: 0.9, roughness: 0.3 }), ({ scene }) => (scene.environmentTexture = surroundings(scene))),
  'pbr: clear coat, sheen': shown(pbr({ albedoColor: mixed(0.5, 0.1, 0.1), roughness: 0.7 }, (material) => {
    Object.assign(material.clearCoat, { isEnabled: true, roughness: 0.1 });
    Object.assign(material.sheen, { isEnabled: true, color: mixed(0.4, 0.5, 0.9) });
  }), ({ scene }) => (scene.environmentTexture = surroundings(scene))),
  'pbr: anisotropy, iridescence': shown(pbr({ albedoColor: mixed(0.7, 0.7, 0.7), metallic: 0.8, roughness: 0.35 }, (material) => {
    Object.assign(material.anisotropy, { isEnabled: true, intensity: 0.7 });
    Object.assign(material.iridescence, { isEnabled: true });
  }), ({ scene }) => (scene.environmentTexture = surroundings(scene))),
  'pbr: translucency': shown(pbr({ albedoColor: mixed(0.8, 0.6, 0.4) }, (material) => Object.assign(material.subSurface, { isTranslucencyEnabled: true, translucencyIntensity: 0.7, tintColor: mixed(0.9, 0.4, 0.3), maximumThickness: 2 }))),
  shadows: shown(standard({ diffuseColor: mixed(0.7, 0.6, 0.3) }), ({ scene, sun, ball, knot }) => {
    const floor = B.MeshBuilder.CreateGround('floor', { width: 8, height: 8 }, scene), generator = new B.ShadowGenerator(256, sun);
    floor.position.y = -1;
    floor.receiveShadows = ball.receiveShadows = true;
    floor.material = new B.StandardMaterial('floor', scene);
    generator.addShadowCaster(ball);
    generator.addShadowCaster(knot);
    generator.usePercentageCloserFiltering = true;
  }),
  'blurred shadows of a lamp': shown(pbr({ albedoColor: mixed(0.7, 0.6, 0.3) }), ({ scene, ball, knot }) => {
    const floor = B.MeshBuilder.CreateGround('floor', { width: 8, height: 8 }, scene), lamp = new B.SpotLight('lamp', new B.Vector3(1, 4, 2), new B.Vector3(0, -4, -2), 1.4, 2, scene);
    lamp.intensity = 60;
    floor.position.y = -1;
    floor.receiveShadows = true;
    floor.material = pbr({ albedoColor: mixed(0.8, 0.8, 0.8) })(scene);
    const generator = new B.ShadowGenerator(128, lamp);
    generator.useBlurExponentialShadowMap = true;
    generator.addShadowCaster(ball);
    generator.addShadowCaster(knot);
  }),
  instances: async ({ scene }) => {
    const box = B.MeshBuilder.CreateBox('box', { size: 0.3 }, scene), thin = B.MeshBuilder.CreateSphere('thin', { diameter: 0.3, segments: 8 }, scene);
    box.material = standard({ diffuseColor: mixed(0.9, 0.9, 0.9) })(scene);
    box.registerInstancedBuffer('color', 4);
    box.instancedBuffers.color = new B.Color4(1, 0.5, 0.2, 1);
    for (let i = 0; i < 12; i++) {
      const each = box.createInstance(`i${i}`);
      each.position.set((i % 4) - 1.5, Math.floor(i / 4) * 0.6 - 0.3, 0);
      each.rotation.y = i;
      each.instancedBuffers.color = new B.Color4(i / 12, 0.6, 1 - i / 12, 1);
    }
    thin.material = pbr({ albedoColor: mixed(0.3, 0.8, 0.4) })(scene);
    thin.thinInstanceAdd(Array.from({ length: 9 }, (_, i) => B.Matrix.Translation((i - 4) * 0.4, -1, 0.3)));
  },
  'a skeleton': shown(standard({ diffuseColor: mixed(0.6, 0.7, 0.3) }), ({ scene, ball }) => {
    const skeleton = new B.Skeleton('s', 's', scene), root = new B.Bone('root', skeleton, null, B.Matrix.Identity()), tip = new B.Bone('tip', skeleton, root, B.Matrix.Identity());
    const positions = ball.getVerticesData(B.VertexBuffer.PositionKind), count = positions.length / 3, indices = new Float32Array(4 * count), weights = new Float32Array(4 * count);
    for (let i = 0; i < count; i++) {
      const top = Math.min(1, Math.max(0, positions[3 * i + 1] + 0.5));
      indices.set([0, 1, 0, 0], 4 * i);
      weights.set([1 - top, top, 0, 0], 4 * i);
    }
    ball.setVerticesData(B.VertexBuffer.MatricesIndicesKind, indices);
    ball.setVerticesData(B.VertexBuffer.MatricesWeightsKind, weights);
    ball.skeleton = skeleton;
    tip.setRotation(new B.Vector3(0, 0, 0.6));
  }),
  'morph targets': shown(pbr({ albedoColor: mixed(0.3, 0.5, 0.8) }), ({ scene, ball }) => {
    const manager = new B.MorphTargetManager(scene), target = new B.MorphTarget('wide', 0.6, scene);
    target.setPositions(ball.getVerticesData(B.VertexBuffer.PositionKind).map((x, i) => (i % 3 === 1 ? 0.4 * x : 1.4 * x)));
    target.setNormals(ball.getVerticesData(B.VertexBuffer.NormalKind));
    manager.addTarget(target);
    ball.morphTargetManager = manager;
  }),
  'fog, clipping, blending': shown(standard({ diffuseColor: mixed(0.9, 0.3, 0.5), alpha: 0.6 }), ({ scene }) => {
    Object.assign(scene, { fogMode: B.Scene.FOGMODE_EXP2, fogDensity: 0.12, fogColor: mixed(0.6, 0.7, 0.8), clipPlane: new B.Plane(0, 1, 0, -0.5) });
  }),
  'a node material': shown((scene) => {
    const material = new B.NodeMaterial('node', scene);
    material.setToDefault();
    material.build(false);
    return material;
  }),
  'a shader of the page': shown((scene) => {
    const material = new B.ShaderMaterial('own', scene, {
      vertexSource: 'precision highp float; attribute vec3 position, normal; attribute vec2 uv; uniform mat4 worldViewProjection, world; varying vec3 n; varying vec2 at; void main() { n = mat3(world) * normal; at = uv; gl_Position = worldViewProjection * vec4(position, 1.0); }',
      fragmentSource: 'precision highp float; uniform sampler2D map; uniform vec3 tints[3]; uniform float time; varying vec3 n; varying vec2 at; void main() { float s = sin(time + 30.0 * at.x) + dFdy(gl_FragCoord.y); gl_FragColor = vec4(tints[int(mod(gl_FragCoord.y / 8.0, 3.0))] * texture2D(map, at).rgb * (0.7 + 0.3 * s) * (0.6 + 0.4 * normalize(n).y), 1.0); }',
    }, { attributes: ['position', 'normal', 'uv'], uniforms: ['worldViewProjection', 'world', 'tints', 'time'], samplers: ['map'] });
    material.setTexture('map', pattern(scene, 32, checks));
    material.setColor3Array('tints', [mixed(1, 0.4, 0.3), mixed(0.3, 1, 0.5), mixed(0.4, 0.5, 1)]);
    material.setFloat('time', 1.2);
    return material;
  }),
  'post processes': shown(pbr({ albedoColor: mixed(0.8, 0.7, 0.4) }), ({ camera, engine }) => {
    new B.BlurPostProcess('blur', new B.Vector2(1, 0.3), 16, 1, camera, B.Texture.BILINEAR_SAMPLINGMODE, engine);
    new B.BlackAndWhitePostProcess('grey', 0.5, camera).degree = 0.6;
  }),
  particles: async ({ scene }) => {
    const system = new B.ParticleSystem('p', 200, scene);
    Object.assign(system, { particleTexture: pattern(scene, 16, (u, v) => [u, v, 1]), emitRate: 2000, minSize: 0.1, maxSize: 0.3, manualEmitCount: 40, blendMode: B.ParticleSystem.BLENDMODE_STANDARD, minEmitPower: 3, maxEmitPower: 4, emitter: B.Vector3.Zero(), color1: new B.Color4(1, 0.6, 0.2, 1), preWarmCycles: 30 });
    system.start();
  },
};
