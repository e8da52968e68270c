// The scenes of three.js: one for each kind of program that it makes. Nothing is loaded: textures and meshes are computed.

import * as THREE from 'three';

export const ENGINE = `three.js ${THREE.REVISION}`;

export function draw(name, canvas, context) {
  const renderer = new THREE.WebGLRenderer({ canvas, context, antialias: false });
  renderer.setSize(canvas.width, canvas.height, false);
  SCENES[name](THREE, renderer);
}

/** A camera, a sun, a lamp, and a sphere and a knot of the material. */
function shown(material, change = () => {}) {
  return (THREE, renderer) => {
    const { scene, camera } = stage(THREE), it = material(THREE, renderer);
    const ball = new THREE.Mesh(new THREE.SphereGeometry(0.9, 48, 32), it), knot = new THREE.Mesh(new THREE.TorusKnotGeometry(0.5, 0.18, 96, 16), it);
    ball.position.x = -1;
    knot.position.x = 1.1;
    scene.add(ball, knot);
    change(THREE, scene, renderer, { ball, knot, camera });
    renderer.render(scene, camera);
  };
}

function stage(THREE, background = 0x223344) {
  const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(40, 4 / 3, 0.1, 50);
  scene.background = new THREE.Color(background);
  camera.position.set(0.8, 1.2, 4.5);
  camera.lookAt(0, 0, 0);
  const sun = new THREE.DirectionalLight(0xfff0dd, 2), lamp = new THREE.PointLight(0x88aaff, 6);
  sun.position.set(2, 3, 4);
  lamp.position.set(-2, 1, 1.5);
  scene.add(sun, lamp, new THREE.HemisphereLight(0x8899aa, 0x332211, 0.7));
  return { scene, camera, sun, lamp };
}

/** A texture of `size` texels, RGBA8, from a function of (u, v) that returns numbers from 0 to 1. */
function pattern(THREE, size, texel, isColor = false) {
  const data = new Uint8Array(size * size * 4);
  for (let i = 0; i < size * size; i++) data.set([...texel(((i % size) + 0.5) / size, (Math.floor(i / size) + 0.5) / size).map((x) => Math.round(255 * x)), 255].slice(0, 4), 4 * i);
  const texture = new THREE.DataTexture(data, size, size);
  Object.assign(texture, { wrapS: THREE.RepeatWrapping, wrapT: THREE.RepeatWrapping, magFilter: THREE.LinearFilter, minFilter: THREE.LinearMipmapLinearFilter, generateMipmaps: true, needsUpdate: true });
  if (isColor) texture.colorSpace = THREE.SRGBColorSpace;
  return texture;
}
const checks = (u, v) => ((Math.floor(u * 8) + Math.floor(v * 8)) % 2 ? [0.9, 0.8, 0.6] : [0.2, 0.35, 0.5]);
const waves = (u, v) => [0.5 + 0.3 * Math.sin(40 * u), 0.5 + 0.3 * Math.sin(40 * v), 0.9];
const grain = (u, v) => [0.5 + 0.5 * Math.sin(50 * u) * Math.sin(30 * v), 0.3 + 0.4 * u, 0.2 + 0.6 * v];

/** Surroundings: a room of boxes in a render target, filtered by three.js. */
function surroundings(THREE, renderer) {
  const room = new THREE.Scene();
  room.add(new THREE.Mesh(new THREE.BoxGeometry(10, 10, 10), new THREE.MeshBasicMaterial({ color: 0x556677, side: THREE.BackSide })));
  for (const [x, y, z, color] of [[4, 3, 0, 0xffeecc], [-4, 1, 2, 0x4488ff], [0, -4, 3, 0xff8844]]) {
    const box = new THREE.Mesh(new THREE.BoxGeometry(2, 2, 2), new THREE.MeshBasicMaterial({ color: new THREE.Color(color).multiplyScalar(3) }));
    box.position.set(x, y, z);
    room.add(box);
  }
  const generator = new THREE.PMREMGenerator(renderer);
  return generator.fromScene(room).texture;
}

const raw = (THREE, parts) => new THREE.RawShaderMaterial({ glslVersion: THREE.GLSL3, ...parts });

export const SCENES = {
  basic: shown((THREE) => new THREE.MeshBasicMaterial({ color: 0x3377cc })),
  'basic with a texture': shown((THREE) => new THREE.MeshBasicMaterial({ map: pattern(THREE, 64, checks, true) })),
  lambert: shown((THREE) => new THREE.MeshLambertMaterial({ color: 0xcc7733, emissive: 0x110500 })),
  'phong with maps': shown((THREE) => new THREE.MeshPhongMaterial({ map: pattern(THREE, 64, checks, true), normalMap: pattern(THREE, 64, waves), specularMap: pattern(THREE, 64, grain), shininess: 60 })),
  'phong with a bump map': shown((THREE) => new THREE.MeshPhongMaterial({ color: 0x99aa66, bumpMap: pattern(THREE, 64, grain), bumpScale: 3 })),
  standard: shown((THREE) => new THREE.MeshStandardMaterial({ color: 0xaa5544, roughness: 0.4, metalness: 0.2 })),
  'standard with maps': shown((THREE) => new THREE.MeshStandardMaterial({
    map: pattern(THREE, 64, checks, true), normalMap: pattern(THREE, 64, waves), roughnessMap: pattern(THREE, 64, grain), metalnessMap: pattern(THREE, 64, grain),
    emissiveMap: pattern(THREE, 32, grain, true), emissive: 0x222222,
  })),
  'standard in surroundings': shown((THREE) => new THREE.MeshStandardMaterial({ color: 0xddbb77, roughness: 0.25, metalness: 1 }), (THREE, scene, renderer) => (scene.environment = surroundings(THREE, renderer))),
  'physical: clear coat': shown((THREE) => new THREE.MeshPhysicalMaterial({ color: 0x882222, roughness: 0.6, clearcoat: 1, clearcoatRoughness: 0.1, clearcoatNormalMap: pattern(THREE, 64, waves) }), (THREE, scene, renderer) => (scene.environment = surroundings(THREE, renderer))),
  'physical: sheen': shown((THREE) => new THREE.MeshPhysicalMaterial({ color: 0x223366, roughness: 0.8, sheen: 1, sheenRoughness: 0.4, sheenColor: 0x88aaff }), (THREE, scene, renderer) => (scene.environment = surroundings(THREE, renderer))),
  'physical: iridescence': shown((THREE) => new THREE.MeshPhysicalMaterial({ color: 0x888888, roughness: 0.2, metalness: 0.3, iridescence: 1, iridescenceIOR: 1.5, iridescenceThicknessRange: [200, 500] }), (THREE, scene, renderer) => (scene.environment = surroundings(THREE, renderer))),
  'physical: anisotropy': shown((THREE) => new THREE.MeshPhysicalMaterial({ color: 0xbbaa99, roughness: 0.4, metalness: 1, anisotropy: 0.8, anisotropyRotation: 0.5 }), (THREE, scene, renderer) => (scene.environment = surroundings(THREE, renderer))),
  'physical: transmission': shown((THREE) => new THREE.MeshPhysicalMaterial({ color: 0xccffdd, roughness: 0.15, transmission: 1, thickness: 0.6, ior: 1.4, attenuationDistance: 1, attenuationColor: 0x66cc88 }), (THREE, scene) => {
    const wall = new THREE.Mesh(new THREE.PlaneGeometry(8, 6), new THREE.MeshBasicMaterial({ map: pattern(THREE, 64, checks, true) }));
    wall.position.z = -2;
    scene.add(wall);
  }),
  toon: shown((THREE) => {
    const steps = new THREE.DataTexture(new Uint8Array([60, 60, 60, 255, 150, 150, 150, 255, 255, 255, 255, 255]), 3, 1);
    Object.assign(steps, { minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter, needsUpdate: true });
    return new THREE.MeshToonMaterial({ color: 0x66bb44, gradientMap: steps });
  }),
  matcap: shown((THREE) => new THREE.MeshMatcapMaterial({ matcap: pattern(THREE, 64, (u, v) => [u, v, 1 - u * v], true) })),
  normal: shown((THREE) => new THREE.MeshNormalMaterial({ flatShading: true })),
  depth: shown((THREE) => new THREE.MeshDepthMaterial(), (THREE, scene, renderer, { camera }) => Object.assign(camera, { near: 3, far: 7 }).updateProjectionMatrix()),
  'a shader of the page': shown((THREE) => new THREE.ShaderMaterial({
    uniforms: { time: { value: 0.7 }, bands: { value: [new THREE.Vector3(1, 0.5, 0.2), new THREE.Vector3(0.1, 0.4, 0.9)] }, turn: { value: new THREE.Matrix3().rotate(0.4) }, isStriped: { value: true } },
    vertexShader: 'uniform float time; varying vec2 at; varying vec3 n; void main() { at = uv; n = normalMatrix * normal; vec3 p = position * (1.0 + 0.05 * sin(9.0 * position.y + time)); gl_Position = projectionMatrix * modelViewMatrix * vec4(p, 1.0); }',
    fragmentShader: 'uniform vec3 bands[2]; uniform mat3 turn; uniform bool isStriped; varying vec2 at; varying vec3 n; void main() { vec3 d = vec3(dFdx(at.x), dFdy(at.y), 0.0); float k = isStriped ? smoothstep(0.4, 0.6, fract(at.x * 12.0)) : 0.0; gl_FragColor = vec4(mix(bands[0], bands[1], k) * (0.4 + 0.6 * abs((turn * normalize(n)).z)) + 4.0 * abs(d) + 0.1 * step(0.5, fract(gl_FragCoord.yxx / 32.0)), 1.0); }',
  })),
  'a raw shader of GLSL ES 3.00': shown((THREE) => raw(THREE, {
    uniforms: { cells: { value: pattern(THREE, 32, checks) } },
    vertexShader: 'in vec3 position; in vec2 uv; uniform mat4 projectionMatrix, modelViewMatrix; flat out int side; out vec2 at; void main() { side = position.x > 0.0 ? 1 : 0; at = uv; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
    fragmentShader: 'precision highp float; uniform sampler2D cells; flat in int side; in vec2 at; out vec4 color; void main() { ivec2 size = textureSize(cells, 0); color = gl_FrontFacing ? texelFetch(cells, ivec2(at * vec2(size)), 0) : vec4(1.0); color.r += float(side) * 0.3; }',
  })),
  instancing: shown((THREE) => new THREE.MeshStandardMaterial({ roughness: 0.5 }), (THREE, scene) => {
    scene.remove(...scene.children.filter((each) => each.isMesh));
    const many = new THREE.InstancedMesh(new THREE.IcosahedronGeometry(0.22, 2), new THREE.MeshStandardMaterial({ roughness: 0.5 }), 60), place = new THREE.Matrix4();
    for (let i = 0; i < 60; i++) {
      many.setMatrixAt(i, place.makeRotationY(i).setPosition(((i % 10) - 4.5) * 0.45, (Math.floor(i / 10) - 2.5) * 0.45, Math.sin(i)));
      many.setColorAt(i, new THREE.Color().setHSL(i / 60, 0.7, 0.5));
    }
    scene.add(many);
  }),
  skinning: shown((THREE) => new THREE.MeshStandardMaterial(), (THREE, scene) => {
    scene.remove(...scene.children.filter((each) => each.isMesh));
    const geometry = new THREE.CylinderGeometry(0.4, 0.5, 3, 24, 24), position = geometry.attributes.position, indices = [], weights = [];
    for (let i = 0; i < position.count; i++) {
      const along = Math.min(1.999, Math.max(0, position.getY(i) / 1.5 + 1)), bone = Math.floor(along);
      indices.push(bone, bone + 1, 0, 0);
      weights.push(1 - (along - bone), along - bone, 0, 0);
    }
    geometry.setAttribute('skinIndex', new THREE.Uint16BufferAttribute(indices, 4));
    geometry.setAttribute('skinWeight', new THREE.Float32BufferAttribute(weights, 4));
    const bones = [0, 1, 2].map(() => new THREE.Bone()), mesh = new THREE.SkinnedMesh(geometry, new THREE.MeshStandardMaterial({ color: 0xcc8866, roughness: 0.7 }));
    bones[0].position.y = -1.5;
    bones[1].position.y = bones[2].position.y = 1.5;
    bones[0].add(bones[1]);
    bones[1].add(bones[2]);
    mesh.add(bones[0]);
    mesh.bind(new THREE.Skeleton(bones));
    bones[1].rotation.z = 0.6;
    bones[2].rotation.x = 0.5;
    scene.add(mesh);
    scene.updateMatrixWorld(true);
  }),
  'morph targets': shown((THREE) => new THREE.MeshPhongMaterial({ color: 0x8866cc }), (THREE, scene, renderer, { ball }) => {
    const geometry = ball.geometry.clone(), position = geometry.attributes.position, moved = [], squeezed = [];
    for (let i = 0; i < position.count; i++) {
      moved.push(0, 0.4 * Math.sin(6 * position.getX(i)), 0);
      squeezed.push(-0.5 * position.getX(i), 0, 0.3 * position.getZ(i));
    }
    geometry.morphAttributes.position = [new THREE.Float32BufferAttribute(moved, 3), new THREE.Float32BufferAttribute(squeezed, 3)];
    geometry.morphTargetsRelative = true;
    ball.geometry = geometry;
    ball.updateMorphTargets();
    ball.morphTargetInfluences[0] = 0.7;
    ball.morphTargetInfluences[1] = 0.5;
  }),
  'shadows of a sun': shown((THREE) => new THREE.MeshStandardMaterial({ color: 0xbbbbaa }), (THREE, scene, renderer, { ball, knot }) => {
    renderer.shadowMap.enabled = true;
    const sun = scene.children.find((each) => each.isDirectionalLight), floor = new THREE.Mesh(new THREE.PlaneGeometry(8, 8), new THREE.MeshStandardMaterial({ color: 0x667788 }));
    sun.castShadow = ball.castShadow = knot.castShadow = ball.receiveShadow = knot.receiveShadow = floor.receiveShadow = true;
    sun.shadow.mapSize.set(256, 256);
    floor.rotation.x = -Math.PI / 2;
    floor.position.y = -1;
    scene.add(floor);
  }),
  'shadows of a lamp and a spot': shown((THREE) => new THREE.MeshStandardMaterial({ color: 0xbbbbaa }), (THREE, scene, renderer, { ball, knot }) => {
    renderer.shadowMap.enabled = true;
    const lamp = scene.children.find((each) => each.isPointLight), spot = new THREE.SpotLight(0xffcc88, 40, 0, 0.6, 0.3), floor = new THREE.Mesh(new THREE.PlaneGeometry(8, 8), new THREE.MeshStandardMaterial({ color: 0x667788 }));
    spot.position.set(1, 4, 2);
    lamp.castShadow = spot.castShadow = ball.castShadow = knot.castShadow = ball.receiveShadow = floor.receiveShadow = true;
    lamp.shadow.mapSize.set(128, 128);
    spot.shadow.mapSize.set(256, 256);
    floor.rotation.x = -Math.PI / 2;
    floor.position.y = -1;
    scene.add(floor, spot);
  }),
  fog: shown((THREE) => new THREE.MeshLambertMaterial({ color: 0xddaa55 }), (THREE, scene) => (scene.fog = new THREE.FogExp2(0x223344, 0.25))),
  'alpha test': shown((THREE) => new THREE.MeshLambertMaterial({ map: pattern(THREE, 64, (u, v) => [...checks(u, v), Math.hypot((u * 8) % 1 - 0.5, (v * 8) % 1 - 0.5) < 0.4 ? 1 : 0], true), alphaTest: 0.5, side: 2 })),
  blending: shown((THREE) => new THREE.MeshStandardMaterial({ color: 0x44aaff, transparent: true, opacity: 0.4 }), (THREE, scene, renderer, { knot }) => {
    const glow = new THREE.Mesh(new THREE.SphereGeometry(0.7, 32, 16), new THREE.MeshBasicMaterial({ color: 0x553311, blending: THREE.AdditiveBlending, transparent: true, depthWrite: false }));
    const shade = new THREE.Mesh(new THREE.PlaneGeometry(2, 0.6), new THREE.MeshBasicMaterial({ color: 0x99cc99, blending: THREE.MultiplyBlending, transparent: true, premultipliedAlpha: true }));
    shade.position.z = glow.position.z = 1;
    knot.material = new THREE.MeshNormalMaterial();
    scene.add(glow, shade);
  }),
  lines: shown((THREE) => new THREE.MeshBasicMaterial({ color: 0xffcc44, wireframe: true }), (THREE, scene, renderer, { knot }) => {
    const points = Array.from({ length: 40 }, (_, i) => new THREE.Vector3(Math.cos(i * 0.4) * 1.5, i * 0.05 - 1, Math.sin(i * 0.4) * 1.5)), line = new THREE.Line(new THREE.BufferGeometry().setFromPoints(points), new THREE.LineDashedMaterial({ color: 0x66ffaa, dashSize: 0.2, gapSize: 0.1 }));
    line.computeLineDistances();
    knot.visible = false;
    scene.add(line);
  }),
  points: shown((THREE) => new THREE.MeshLambertMaterial({ color: 0x334455 }), (THREE, scene) => {
    const places = Float32Array.from({ length: 900 }, (_, i) => 3 * Math.sin(i * 12.9898 + Math.floor(i / 3)));
    scene.add(new THREE.Points(new THREE.BufferGeometry().setAttribute('position', new THREE.BufferAttribute(places, 3)), new THREE.PointsMaterial({ color: 0xffffaa, size: 1, sizeAttenuation: false })));
  }),
  'clipping planes': shown((THREE, renderer) => {
    renderer.localClippingEnabled = true;
    return new THREE.MeshPhongMaterial({ color: 0x55aacc, side: THREE.DoubleSide, clippingPlanes: [new THREE.Plane(new THREE.Vector3(-1, 1, 0).normalize(), 0.3)] });
  }),
  'a cube map and vertex colours': shown((THREE) => new THREE.MeshLambertMaterial({ vertexColors: true }), (THREE, scene, renderer, { ball, knot }) => {
    const faces = [0, 1, 2, 3, 4, 5].map((face) => pattern(THREE, 32, (u, v) => [face / 5, u, v])), cube = new THREE.CubeTexture(faces);
    Object.assign(cube, { needsUpdate: true, generateMipmaps: false, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter });
    knot.material = new THREE.MeshBasicMaterial({ envMap: cube, reflectivity: 0.8 });
    scene.background = cube;
    const colors = Uint8Array.from({ length: ball.geometry.attributes.position.count * 3 }, (_, i) => (i * 37) % 256);
    ball.geometry.setAttribute('color', new THREE.BufferAttribute(colors, 3, true));
  }),
  displacement: shown((THREE) => new THREE.MeshStandardMaterial({ color: 0x77aa88, displacementMap: pattern(THREE, 64, grain), displacementScale: 0.3, aoMap: pattern(THREE, 64, grain) })),
  'a sprite': shown((THREE) => new THREE.MeshLambertMaterial({ color: 0xcccccc }), (THREE, scene) => {
    const sprite = new THREE.Sprite(new THREE.SpriteMaterial({ map: pattern(THREE, 32, checks, true), rotation: 0.3 }));
    sprite.position.set(0, 1, 1);
    scene.add(sprite);
  }),
  'batched meshes': shown((THREE) => new THREE.MeshLambertMaterial(), (THREE, scene) => {
    scene.remove(...scene.children.filter((each) => each.isMesh));
    const mesh = new THREE.BatchedMesh(20, 5000, 10000, new THREE.MeshLambertMaterial()), kinds = [new THREE.BoxGeometry(0.4, 0.4, 0.4), new THREE.SphereGeometry(0.25, 16, 12)].map((each) => mesh.addGeometry(each)), place = new THREE.Matrix4();
    for (let i = 0; i < 20; i++) {
      const id = mesh.addInstance(kinds[i % 2]);
      mesh.setMatrixAt(id, place.makeRotationX(i).setPosition(((i % 5) - 2) * 0.7, (Math.floor(i / 5) - 1.5) * 0.7, 0));
      mesh.setColorAt(id, new THREE.Color().setHSL(i / 20, 0.6, 0.5));
    }
    scene.add(mesh);
  }),
  'tone mapping': shown((THREE) => new THREE.MeshStandardMaterial({ color: 0xffffff, roughness: 0.3 }), (THREE, scene, renderer) => Object.assign(renderer, { toneMapping: THREE.ACESFilmicToneMapping, toneMappingExposure: 1.4 })),
  'a pass behind the picture': (THREE, renderer) => {
    const target = new THREE.WebGLRenderTarget(256, 192, { type: THREE.HalfFloatType }), screen = new THREE.Scene(), flat = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    renderer.setRenderTarget(target);
    shown((three) => new three.MeshStandardMaterial({ color: 0xddaa88, roughness: 0.5 }))(THREE, renderer);
    renderer.setRenderTarget(null);
    const fragmentShader = 'uniform sampler2D picture; varying vec2 at; void main() { vec2 from = at - 0.5; vec4 sum = vec4(0.0); for (int i = 0; i < 8; i++) sum += texture2D(picture, 0.5 + from * (1.0 - 0.01 * float(i))); gl_FragColor = sum / 8.0 * (1.0 - dot(from, from)); gl_FragColor.g *= 0.8 + 0.2 * at.y; }';
    screen.add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({ uniforms: { picture: { value: target.texture } }, vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }', fragmentShader })));
    renderer.render(screen, flat);
  },
  'two colours at once': (THREE, renderer) => {
    const target = new THREE.WebGLRenderTarget(256, 192, { count: 2 }), screen = new THREE.Scene(), flat = new THREE.OrthographicCamera(-1, 1, 1, -1, 0, 1);
    renderer.setRenderTarget(target);
    shown((three) => raw(three, {
      vertexShader: 'in vec3 position; in vec3 normal; uniform mat4 projectionMatrix, modelViewMatrix; uniform mat3 normalMatrix; out vec3 n; void main() { n = normalMatrix * normal; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }',
      fragmentShader: 'precision highp float; in vec3 n; layout(location = 0) out vec4 color; layout(location = 1) out vec4 normals; void main() { color = vec4(0.8, 0.5, 0.3, 1.0) * max(n.z, 0.0); normals = vec4(normalize(n) * 0.5 + 0.5, 1.0); }',
    }), (THREE, scene) => (scene.background = null))(THREE, renderer);
    renderer.setRenderTarget(null);
    screen.add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), new THREE.ShaderMaterial({
      uniforms: { left: { value: target.textures[0] }, right: { value: target.textures[1] } }, vertexShader: 'varying vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0.0, 1.0); }',
      fragmentShader: 'uniform sampler2D left, right; varying vec2 at; void main() { gl_FragColor = at.x + at.y < 1.0 ? texture2D(left, at) : texture2D(right, at); }',
    })));
    renderer.render(screen, flat);
  },
};
