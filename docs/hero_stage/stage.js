// Draws a hero with three.js: a picture is the mean of many frames, each from another point of the lens, of a pixel and of the lamps.

import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';

const vector = (values) => new THREE.Vector3(...values);
const bytesOf = async (file) => (await fetch(file)).arrayBuffer();

/** A picture of the model as a texture. */
async function pictureOf(name) {
  const texture = await new THREE.TextureLoader().loadAsync(`${name}.png`);
  return Object.assign(texture, { colorSpace: THREE.SRGBColorSpace, anisotropy: 8, wrapS: THREE.RepeatWrapping, wrapT: THREE.RepeatWrapping });
}

/** Number `index` of a sequence that covers the unit square or cube evenly (Roberts, the R sequence). */
function spread(index, count) {
  let root = 2;
  for (let round = 0; round < 30; round += 1) root = (1 + root) ** (1 / (count + 1));
  return Array.from({ length: count }, (_, axis) => (0.5 + (index + 1) / root ** (axis + 1)) % 1);
}

/** A point of the unit disc. */
function onDisc(a, b) {
  const radius = Math.sqrt(a), angle = 2 * Math.PI * b;
  return [radius * Math.cos(angle), radius * Math.sin(angle)];
}

/** The far surroundings: a picture, and directions of it at random, by how bright they are. */
class Sky {
  constructor(texels, [width, height]) {
    this.size = [width, height];
    this.texels = texels;
    this.texture = new THREE.DataTexture(texels, width, height, THREE.RGBAFormat, THREE.FloatType);
    Object.assign(this.texture, {
      mapping: THREE.EquirectangularReflectionMapping, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter,
      wrapS: THREE.RepeatWrapping, needsUpdate: true,
    });
    this.sums = new Float64Array(width * height);
    let sum = 0;
    for (let at = 0; at < this.sums.length; at += 1) {
      const polar = Math.PI * (0.5 + Math.floor(at / width)) / height;
      sum += Math.sin(polar) * (texels[4 * at] + texels[4 * at + 1] + texels[4 * at + 2]);
      this.sums[at] = sum;
    }
  }

  /** A direction and its irradiance over the chance of it, for a random number. */
  sample(chance) {
    const [width, height] = this.size, total = this.sums[this.sums.length - 1], wanted = chance * total;
    let low = 0, high = this.sums.length - 1;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.sums[middle] < wanted) low = middle + 1;
      else high = middle;
    }
    const rgb = [0, 1, 2].map((part) => this.texels[4 * low + part]);
    const around = 2 * Math.PI * ((low % width + 0.5) / width - 0.5), up = Math.PI * ((Math.floor(low / width) + 0.5) / height - 0.5);
    const way = new THREE.Vector3(Math.cos(up) * Math.cos(around), Math.sin(up), Math.cos(up) * Math.sin(around));
    const share = 2 * Math.PI * Math.PI / (width * height) * total / Math.max(rgb[0] + rgb[1] + rgb[2], 1e-9);
    return { way, irradiance: rgb.map((part) => part * share) };
  }
}

const BLACK = new THREE.MeshBasicMaterial({ color: 0, shadowSide: THREE.FrontSide });
const UNSEEN = new THREE.MeshBasicMaterial({ colorWrite: false, depthWrite: false });

class Stage {
  constructor(hero, width, height, { shadowTexels = 2048, skyLights = 2 } = {}) {
    this.hero = hero;
    this.size = [width, height];
    this.renderer = new THREE.WebGLRenderer();
    Object.assign(this.renderer.shadowMap, { enabled: true, type: THREE.PCFShadowMap });
    this.scene = new THREE.Scene();
    this.shadowTexels = shadowTexels;
    this.skyLights = skyLights;
    this.bodies = [];
    this.props = [];
    const settings = { type: THREE.FloatType, minFilter: THREE.NearestFilter, magFilter: THREE.NearestFilter };
    this.target = new THREE.WebGLRenderTarget(width, height, settings);
    this.sums = [0, 1].map(() => new THREE.WebGLRenderTarget(width, height, { ...settings, depthBuffer: false }));
    this.count = 0;
    const uniforms = { before: { value: null }, added: { value: null } };
    this.adding = new THREE.ShaderMaterial({
      uniforms, depthTest: false, depthWrite: false,
      vertexShader: 'void main() { gl_Position = vec4(position.xy, 0.0, 1.0); }',
      fragmentShader: 'uniform sampler2D before, added; void main() { ivec2 at = ivec2(gl_FragCoord.xy); gl_FragColor = vec4(texelFetch(before, at, 0).rgb + clamp(texelFetch(added, at, 0).rgb, 0.0, 300.0), 1.0); }',
    });
    // the scene without bodies, which clear bodies show
    const side = 2 ** Math.floor(Math.log2(Math.min(Math.max(width, height), 2048)));
    this.behind = new THREE.WebGLRenderTarget(side, side, { type: THREE.HalfFloatType, generateMipmaps: true, minFilter: THREE.LinearMipmapLinearFilter });
    this.sheet = new THREE.Scene().add(new THREE.Mesh(new THREE.PlaneGeometry(2, 2), this.adding));
    this.eye = new THREE.Camera();
  }

  async load() {
    const { hero, scene } = this;
    this.sky = new Sky(new Float32Array(await bytesOf('sky.bin')), hero.sky);
    const loader = new GLTFLoader(), geometries = {};
    for (const { mesh } of [...hero.bodies, ...hero.props]) {
      if (geometries[mesh]) continue;
      const { scene: model } = await loader.loadAsync(`${mesh}.glb`);
      model.traverse((part) => { if (part.isMesh) geometries[mesh] = part.geometry; });
      geometries[mesh].computeBoundingBox();
      geometries[mesh].computeBoundingSphere();
    }
    const put = (list, { mesh, places }, material) => {
      for (const [x, y, z, turn = 0, scale = 1, tilt = 0, roll = 0] of places) {
        const object = new THREE.Mesh(geometries[mesh], material);
        object.position.set(x, y, z);
        object.rotation.set(...[tilt, turn, roll].map(THREE.MathUtils.degToRad), 'YXZ');
        object.scale.setScalar(scale);
        object.castShadow = object.receiveShadow = true;
        object.userData.material = material;
        scene.add(object);
        list.push(object);
      }
    };
    for (const body of hero.bodies) put(this.bodies, body, await this.#bodyMaterial(body));
    for (const prop of hero.props) put(this.props, prop, await this.#propMaterial(prop, Boolean(geometries[prop.mesh].attributes.color)));
    for (const object of this.props) object.castShadow = !object.userData.material.userData.shines;
    scene.updateMatrixWorld();
    this.box = new THREE.Box3();
    for (const object of this.bodies) this.box.expandByObject(object);
    this.ball = this.box.getBoundingSphere(new THREE.Sphere());
    this.#lights();
    this.#glows();
    this.#camera();
    this.#surroundings();
  }

  async #bodyMaterial({ material, response, parameters, inclusions, medium, pictures }) {
    const { createMaterial } = await import(`./${material.replace('.toml', '.js')}`);
    const made = createMaterial();
    if (response) made.innerLight = { data: await bytesOf(response), facts: await (await fetch(`${response}.json`)).json() };
    // what is not scattered has the medium's extinction
    if ('seenThroughBodyExtinction' in made) made.setValues({ seenThroughBodyExtinction: medium.absorption.map((part, at) => part + medium.scattering[at]), seenThroughBodyIor: medium.ior });
    made.setValues(parameters);
    for (const [name, picture] of Object.entries(pictures)) made[name] = await pictureOf(picture);
    made.shadowSide = THREE.FrontSide;
    made.ior = Math.max(medium?.ior ?? 1.5, 1);
    if (inclusions) {
      const [width, height, depth, channels] = this.hero.volumes[inclusions];
      const bytes = new Uint8Array(await bytesOf(`${inclusions}.volume`)), texels = new Uint8Array(4 * width * height * depth);
      for (let at = 0; at < width * height * depth; at += 1) {
        for (let part = 0; part < 4; part += 1) texels[4 * at + part] = part < 3 ? bytes[channels * at + Math.min(part, channels - 1)] : 255;
      }
      const texture = new THREE.Data3DTexture(texels, width, height, depth);
      made.inclusions = Object.assign(texture, { format: THREE.RGBAFormat, minFilter: THREE.LinearFilter, magFilter: THREE.LinearFilter, needsUpdate: true });
    }
    return made;
  }

  async #propMaterial({ color, roughness, metalness, emission, picture }, vertexColors) {
    if (Math.max(...emission) > 0) {
      return new THREE.MeshBasicMaterial({ vertexColors, color: new THREE.Color(...emission), userData: { shines: true } });
    }
    const material = new THREE.MeshStandardMaterial({ roughness, metalness, vertexColors });
    material.color.setRGB(...color);
    if (picture) {
      material.map = await pictureOf(picture);
    }
    return material;
  }

  #lights() {
    const { hero, scene, ball } = this;
    this.lamps = hero.lamps.map(({ position, intensity, radius, target, cone }) => {
      const strength = Math.max(...intensity);
      const light = target ? new THREE.SpotLight(0xffffff, strength, 0, THREE.MathUtils.degToRad(cone / 2), 0.2) : new THREE.PointLight(0xffffff, strength);
      light.color.setRGB(...intensity.map((part) => part / strength));
      light.position.copy(vector(position));
      if (target) {
        light.target.position.copy(vector(target));
        scene.add(light.target);
      }
      const away = vector(position).distanceTo(ball.center);
      Object.assign(light.shadow.camera, { near: Math.max(0.02, away - 1.5 * ball.radius), far: 3 * (away + ball.radius) });
      this.#shadow(light);
      light.userData = { place: vector(position), radius };
      return light;
    });
    this.skies = Array.from({ length: this.skyLights }, () => {
      const light = new THREE.DirectionalLight();
      const side = 1.6 * ball.radius;
      Object.assign(light.shadow.camera, { left: -side, right: side, top: side, bottom: -side, near: 0, far: 12 * ball.radius });
      light.target.position.copy(ball.center);
      this.#shadow(light);
      scene.add(light.target);
      return light;
    });
  }

  /** Whether light comes through bodies into their shadows. */
  get #shades() {
    return Math.max(...this.hero.shade) > 0;
  }

  /** The strength of each lamp, as a factor, for props or for bodies. */
  #shine(share) {
    for (const [number, lamp] of this.lamps.entries()) {
      const { intensity } = this.hero.lamps[number], values = intensity.map((part, at) => part * share[at]);
      lamp.intensity = Math.max(...values, 1e-9);
      lamp.color.setRGB(...values.map((part) => part / lamp.intensity));
    }
  }

  /** What the light that leaves bodies does to props. */
  #glows() {
    this.glows = [];
    for (const { glow, glow_height: height, places } of this.hero.bodies) {
      if (Math.max(...glow) === 0) continue;
      for (const [x, y, z, , scale = 1] of places) {
        const strength = Math.max(...glow), light = new THREE.PointLight(0xffffff, strength * scale ** 2);
        light.color.setRGB(...glow.map((part) => part / strength));
        light.position.set(x, y + height * scale, z);
        this.glows.push(light);
        this.scene.add(light);
      }
    }
  }

  #shadow(light) {
    light.castShadow = true;
    light.shadow.mapSize.set(this.shadowTexels, this.shadowTexels);
    light.shadow.radius = 1;
    light.shadow.normalBias = 0.001 * this.ball.radius;
    light.shadow.bias = -0.0002;
    this.scene.add(light);
  }

  #camera() {
    const { position, target, field_of_view: angle, focus } = this.hero.camera, [width, height] = this.size;
    this.camera = new THREE.PerspectiveCamera(angle, width / height, 0.05, 200);
    this.camera.position.copy(vector(position));
    this.camera.lookAt(vector(target));
    this.camera.updateMatrixWorld();
    const forward = new THREE.Vector3();
    this.camera.getWorldDirection(forward);
    this.focus = vector(focus).sub(this.camera.position).dot(forward);
    this.place = this.camera.position.clone();
  }

  /** What is around the bodies as their own picture: the sky with the props in it. */
  #surroundings() {
    const { scene, renderer } = this, around = new THREE.Scene();
    const generator = new THREE.PMREMGenerator(renderer);
    const sky = generator.fromEquirectangular(this.sky.texture).texture;
    for (const object of this.bodies) object.material = UNSEEN;
    scene.background = this.sky.texture;
    scene.environment = sky;
    for (const light of [...this.skies, ...this.glows]) light.visible = false;
    this.nearby = generator.fromScene(scene, 0, 0.05, 100, { size: 256, position: this.ball.center }).texture;
    for (const object of this.bodies) object.material = object.userData.material;
    scene.environment = null;
    around.clear();
  }

  /** Begins a new picture, with the lamps turned about the bodies by an angle in degrees. */
  turn(angle) {
    this.count = 0;
    this.renderer.setClearColor(0, 0);
    this.renderer.setRenderTarget(this.sums[0]);
    this.renderer.clear();
    for (const [number, lamp] of this.lamps.entries()) {
      const away = vector(this.hero.lamps[number].position).sub(this.ball.center);
      lamp.userData.place = away.applyAxisAngle(new THREE.Vector3(0, 1, 0), THREE.MathUtils.degToRad(angle)).add(this.ball.center);
    }
  }

  /** Adds a frame to the picture. */
  frame() {
    const { renderer, camera, hero } = this, [width, height] = this.size, index = this.count;
    const paired = this.#shades ? index >> 1 : index; // frames with and without a shadow have the same light
    const [a, b, c, d] = spread(index, 4), [e, f, g] = spread(paired, 3);
    const [x, y] = onDisc(a, b).map((part) => part * hero.camera.aperture);
    const scale = height / 2 / Math.tan(THREE.MathUtils.degToRad(camera.fov / 2)) / this.focus;
    camera.setViewOffset(width, height, -x * scale + c - 0.5, y * scale + d - 0.5, width, height);
    camera.position.copy(this.place).add(new THREE.Vector3(x, y, 0).applyQuaternion(camera.quaternion));
    camera.updateMatrixWorld();
    for (const [number, lamp] of this.lamps.entries()) {
      const [s, t] = spread(paired + 1000 * number, 2), u = 2 * s - 1, ring = Math.sqrt(1 - u * u), turn = 2 * Math.PI * t;
      const { place, radius } = lamp.userData, size = radius * Math.cbrt((e + 0.618 * number) % 1);
      lamp.position.copy(place).add(new THREE.Vector3(ring * Math.cos(turn), u, ring * Math.sin(turn)).multiplyScalar(size));
    }
    for (const [number, light] of this.skies.entries()) {
      const { way, irradiance } = this.sky.sample((f + number / this.skies.length + 0.31 * number * g) % 1);
      const strength = Math.max(...irradiance, 1e-9) / this.skies.length;
      light.position.copy(this.ball.center).addScaledVector(way, 6 * this.ball.radius);
      light.color.setRGB(...irradiance.map((part) => part / this.skies.length / strength));
      light.intensity = strength;
    }
    this.count += 1;
    this.#opaque();
    this.#translucent();
    renderer.readRenderTargetPixels(this.sums[0], 0, 0, 1, 1, new Float32Array(4)); // waits until it is drawn
  }

  /** The props under lamps and sky, and the sky; bodies are black. */
  #opaque() {
    const { scene, hero } = this;
    scene.background = this.sky.texture;
    scene.backgroundIntensity = hero.surroundings.shown;
    scene.environment = null;
    for (const light of [...this.skies, ...this.glows]) light.visible = true;
    // light that comes through bodies: in each second frame they cast no shadow
    const shaded = this.count % 2 > 0, share = hero.shade.map((part) => (shaded ? 2 - 2 * part : 2 * part));
    const shades = this.#shades;
    if (shades) {
      this.#shine(share);
      for (const light of this.skies) light.color.setRGB(...['r', 'g', 'b'].map((part, at) => light.color[part] * share[at]));
    }
    for (const object of this.bodies) object.castShadow = shaded || !shades;
    this.#behind();
    for (const object of this.bodies) object.material = BLACK;
    this.#add();
    for (const object of this.bodies) object.material = object.userData.material;
    if (shades) this.#shine([1, 1, 1]);
  }

  /** The picture of what is behind clear bodies. */
  #behind() {
    const clear = this.bodies.filter(({ userData }) => 'sceneBehindMap' in userData.material);
    if (!clear.length) return;
    const { renderer, camera, behind } = this, half = new THREE.Matrix4().set(0.5, 0, 0, 0.5, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0, 1);
    for (const object of this.bodies) object.material = UNSEEN;
    renderer.setRenderTarget(behind);
    renderer.clear();
    renderer.render(this.scene, camera);
    const values = {
      sceneBehindMap: behind.texture, sceneBehindLevels: Math.log2(behind.width),
      sceneBehindMatrix: half.multiply(camera.projectionMatrix).multiply(camera.matrixWorldInverse),
    };
    for (const { userData } of clear) Object.assign(userData.material, values);
  }

  /** The bodies under lamps and surroundings; props are black. */
  #translucent() {
    const { scene } = this;
    scene.background = null;
    scene.environment = this.nearby;
    for (const light of [...this.skies, ...this.glows]) light.visible = false;
    for (const object of this.props) object.material = BLACK;
    this.renderer.shadowMap.autoUpdate = false; // the lamps have those of the frame's first half
    this.#add();
    this.renderer.shadowMap.autoUpdate = true;
    for (const object of this.props) object.material = object.userData.material;
  }

  #add() {
    const { renderer, adding, sums } = this;
    renderer.setClearColor(0, 0);
    renderer.setRenderTarget(this.target);
    renderer.clear();
    renderer.render(this.scene, this.camera);
    adding.uniforms.before.value = sums[0].texture;
    adding.uniforms.added.value = this.target.texture;
    renderer.setRenderTarget(sums[1]);
    renderer.render(this.sheet, this.eye);
    renderer.setRenderTarget(null);
    sums.reverse();
  }

  /** The mean of the frames: base64 of floats, RGBA, row 0 below. */
  picture() {
    const [width, height] = this.size, pixels = new Float32Array(4 * width * height);
    this.renderer.readRenderTargetPixels(this.sums[0], 0, 0, width, height, pixels);
    const bytes = new Uint8Array(pixels.map((value) => value / this.count).buffer);
    let text = '';
    for (let at = 0; at < bytes.length; at += 32768) text += String.fromCharCode(...bytes.subarray(at, at + 32768));
    return btoa(text);
  }
}

/** A stage for the page's hero. */
export async function open() {
  const hero = await (await fetch('hero.json')).json(), given = new URLSearchParams(location.search);
  const stage = new Stage(hero, Number(given.get('width')), Number(given.get('height')));
  await stage.load();
  return stage;
}
