// pixi.js: sprites, meshes, graphics, text, its filters and blend modes, with WebGL 2 and WebGL 1.

import * as PIXI from 'pixi.js';
import 'pixi.js/advanced-blend-modes';
import { canvas, run } from './pages_common.js';

const texture = () => PIXI.Texture.from(Object.assign(document.createElement('canvas'), { width: 8, height: 8 }));
const MODES = ['color', 'color-burn', 'color-dodge', 'darken', 'difference', 'divide', 'exclusion', 'hard-light', 'hard-mix', 'lighten', 'linear-burn', 'linear-dodge', 'linear-light', 'luminosity', 'negation', 'overlay', 'pin-light', 'saturation', 'soft-light', 'subtract', 'vivid-light'];

const CONTENTS = {
  sprite: () => new PIXI.Sprite(texture()),
  'many textures': () => {
    const group = new PIXI.Container();
    for (let index = 0; index < 6; index++) group.addChild(new PIXI.Sprite(texture()));
    return group;
  },
  tiling: () => new PIXI.TilingSprite({ texture: texture(), width: 20, height: 20 }),
  'nine slices': () => new PIXI.NineSliceSprite({ texture: texture(), leftWidth: 2, rightWidth: 2, topHeight: 2, bottomHeight: 2 }),
  graphics: () => new PIXI.Graphics().circle(8, 8, 6).fill(0xff0000).stroke({ width: 2, color: 0x00ff00 }),
  'large graphics': () => new PIXI.Graphics().poly(Array.from({ length: 2000 }, (_, index) => Math.sin(index * 0.3) * (index % 30))).fill(0xff00ff),
  mesh: () => new PIXI.MeshPlane({ texture: texture(), verticesX: 12, verticesY: 12 }),
  rope: () => new PIXI.MeshRope({ texture: texture(), points: [0, 9, 18].map((x) => new PIXI.Point(x, x)) }),
  perspective: () => new PIXI.PerspectiveMesh({ texture: texture(), verticesX: 4, verticesY: 4, x0: 0, y0: 0, x1: 9, y1: 1, x2: 8, y2: 8, x3: 1, y3: 9 }),
  particles: () => {
    const group = new PIXI.ParticleContainer({ texture: texture(), dynamicProperties: { rotation: true, color: true, uvs: true, vertex: true } });
    group.addParticle(new PIXI.Particle({ texture: texture(), tint: 0xff0000 }));
    return group;
  },
  text: () => new PIXI.Text({ text: 'text', style: { fontSize: 12 } }),
  'bitmap text': () => new PIXI.BitmapText({ text: 'text', style: { fontSize: 12 } }),
  'mask by a sprite': () => {
    const sprite = new PIXI.Sprite(texture());
    const mask = new PIXI.Sprite(texture());
    sprite.mask = mask;
    return Object.assign(new PIXI.Container(), {}).addChild(sprite, mask).parent;
  },
  'mask by alpha, inverse': () => {
    const sprite = new PIXI.Sprite(texture());
    const mask = new PIXI.Sprite(texture());
    sprite.setMask({ mask, inverse: true });
    return new PIXI.Container().addChild(sprite, mask).parent;
  },
};
const FILTERS = {
  alpha: () => new PIXI.AlphaFilter(), colors: () => new PIXI.ColorMatrixFilter(), noise: () => new PIXI.NoiseFilter(),
  displacement: () => new PIXI.DisplacementFilter(new PIXI.Sprite(texture())), threshold: () => new PIXI.Filter({ glProgram: PIXI.GlProgram.from({ vertex: PIXI.defaultFilterVert, fragment: 'in vec2 vTextureCoord; out vec4 finalColor; uniform sampler2D uTexture; void main() { finalColor = step(0.5, texture(uTexture, vTextureCoord)); }' }), resources: {} }),
};
for (const size of [5, 7, 9, 11, 13, 15]) FILTERS[`blur ${size}`] = () => new PIXI.BlurFilter({ kernelSize: size });

const steps = [];
for (const version of [2, 1]) {
  let renderer;
  const draw = (content) => {
    const stage = new PIXI.Container();
    stage.addChild(content);
    renderer.render(stage);
  };
  steps.push([`WebGL ${version}`, async () => {
    renderer = new PIXI.WebGLRenderer();
    await renderer.init({ canvas: canvas(), width: 32, height: 32, preferWebGLVersion: version, useBackBuffer: true });
  }]);
  for (const [name, make] of Object.entries(CONTENTS)) steps.push([`${name} ${version}`, () => draw(make())]);
  for (const [name, make] of Object.entries(FILTERS)) steps.push([`filter ${name} ${version}`, () => draw(Object.assign(CONTENTS.graphics(), { filters: [make()] }))]);
  for (const mode of MODES) {
    steps.push([`blend ${mode} ${version}`, () => {
      const group = new PIXI.Container();
      group.addChild(CONTENTS.graphics(), Object.assign(CONTENTS.graphics(), { blendMode: mode }));
      draw(group);
    }]);
  }
}

run(steps);
