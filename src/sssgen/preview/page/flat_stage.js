// A picture without a body: one triangle with a fragment shader, in WebGL 2. The time runs, or is set by hand.

import { make } from './elements.js';

const LONGEST = 20;

/** One canvas with one program; it has the methods of `Stage`. */
export class FlatStage {
  /** @type {WebGL2RenderingContext} */
  gl;  // from start() on
  /** @type {import('../page_messages.js').FlatPicture} */
  picture;  // from show() on
  /** @type {WebGLProgram | null} */
  program = null;

  /** @param {HTMLElement} root @param {import('../page_messages.js').PieceOf} pieceOf */
  constructor(root, pieceOf) {
    this.root = root;
    this.pieceOf = pieceOf;
    this.kind = 'flat';
    this.time = 0;
    this.frames = 0;  // since the start
    this.drawn = 0;
    this.mouse = [0, 0, 0, 0];
    this.last = 0;  // when the time was counted, in milliseconds
    /** @type {import('../page_messages.js').Values} */
    this.values = new Map();
    /** @type {{ name: string, dim: string, texture: WebGLTexture }[]} */
    this.textures = [];
    this.drafts = { sharp: false };
    /** @type {WeakMap<WebGLProgram, Map<string, number>>} */
    this.types = new WeakMap();  // of the uniforms
    this.canvas = make('canvas');
    this.play = make('button', { className: 'play', title: 'Let the time run, or stop it' });
    this.clock = make('input', { type: 'range', min: 0, max: LONGEST, step: 0.01, title: 'The time' });
    this.shownTime = make('span', { className: 'unit' });
    this.bar = make('div', { className: 'clock' }, this.play, this.clock, this.shownTime);
    this.sizes = new ResizeObserver(() => this.ask());
  }

  async start() {
    const gl = this.canvas.getContext('webgl2', { preserveDrawingBuffer: true });
    if (!gl) throw new Error('this browser has no WebGL 2');
    this.gl = gl;
    this.root.replaceChildren(this.canvas, this.bar);
    this.play.addEventListener('click', () => this.run(!this.plays));
    this.clock.addEventListener('input', () => { this.run(false); this.time = Number(this.clock.value); this.ask(); });
    this.canvas.addEventListener('pointermove', (event) => { if (event.buttons) this.point(event); });
    this.canvas.addEventListener('pointerdown', (event) => this.point(event, true));
    this.sizes.observe(this.root);
  }

  /** @param {PointerEvent} event @param {boolean} [first]  whether a button was just pressed */
  point(event, first) {
    const box = this.canvas.getBoundingClientRect();
    const scale = this.canvas.width / box.width;
    const at = [(event.clientX - box.left) * scale, (box.bottom - event.clientY) * scale];
    this.mouse = first ? [...at, ...at] : [...at, ...this.mouse.slice(2)];
    this.ask();
  }

  /** @param {import('../page_messages.js').FlatPicture} picture @param {import('../page_messages.js').Values} values */
  async show(picture, values) {
    const { gl } = this;
    const filled = picture.textures.flatMap(({ property, texels }) => (texels ? [{ property, texels }] : []));
    const pieces = await Promise.all(filled.map(({ texels }) => Promise.all(texels.levels.map((level) => this.pieceOf(level.data)))));
    const program = this.link(picture.flat);
    if (this.program) gl.deleteProgram(this.program);
    this.textures.forEach(({ texture }) => gl.deleteTexture(texture));
    this.program = program;
    this.textures = filled.map(({ property, texels }, index) => ({ name: property, dim: texels.dim, texture: this.upload(texels, pieces[index]) }));
    this.controls = new Map(picture.controls.map((control) => [control.property, control]));
    this.values = new Map(picture.controls.map(({ property, value }) => [property, values.get(property) ?? value]));
    const first = this.picture?.name !== picture.name;
    this.picture = picture;
    if (first) this.time = picture.flat.start;
    this.bar.hidden = !Object.values(picture.flat.given).includes('time');
    this.canvas.style.filter = picture.exposure === 1 ? '' : `brightness(${picture.exposure ** (1 / 2.2)})`;
    if (first) this.run(picture.flat.plays && !this.bar.hidden);
    this.frame();
    if (gl.isContextLost()) throw new Error('the graphics driver gave up: the shader takes too long');
  }

  /** @param {import('../page_messages.js').Flat} flat */
  link({ vertex, fragment }) {
    const { gl } = this;
    const program = gl.createProgram();
    for (const [kind, text] of /** @type {[number, string][]} */ ([[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]])) {
      const shader = gl.createShader(kind);
      if (!shader) continue;  // the context is lost
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) throw new Error(gl.getShaderInfoLog(shader) ?? '');
      gl.attachShader(program, shader);
      gl.deleteShader(shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) throw new Error(gl.getProgramInfoLog(program) ?? '');
    return program;
  }

  /** @param {import('../page_messages.js').Texels} texture @param {ArrayBuffer[]} texels  of its levels */
  upload({ dim, filter, wrap, levels }, texels) {
    const { gl } = this;
    const texture = gl.createTexture();
    const place = dim === '3D' ? gl.TEXTURE_3D : gl.TEXTURE_2D;
    gl.bindTexture(place, texture);
    levels.forEach(({ size: [width, height, depth] }, level) => {
      const data = new Uint16Array(texels[level]);
      if (dim === '3D') gl.texImage3D(place, level, gl.RGBA16F, width, height, depth, 0, gl.RGBA, gl.HALF_FLOAT, data);
      else gl.texImage2D(place, level, gl.RGBA16F, width, height, 0, gl.RGBA, gl.HALF_FLOAT, data);
    });
    const kept = { repeat: gl.REPEAT, clamp: gl.CLAMP_TO_EDGE, mirror: gl.MIRRORED_REPEAT }[wrap];
    const mag = filter === 'nearest' ? gl.NEAREST : gl.LINEAR;
    for (const axis of [gl.TEXTURE_WRAP_S, gl.TEXTURE_WRAP_T, gl.TEXTURE_WRAP_R]) gl.texParameteri(place, axis, kept);
    gl.texParameteri(place, gl.TEXTURE_MAG_FILTER, mag);
    gl.texParameteri(place, gl.TEXTURE_MIN_FILTER, levels.length > 1 ? gl.LINEAR_MIPMAP_LINEAR : mag);
    gl.texParameteri(place, gl.TEXTURE_MAX_LEVEL, levels.length - 1);
    return texture;
  }

  /** @param {string} property @param {number[]} numbers */
  set(property, numbers) {
    this.values.set(property, numbers);
    this.ask();
  }

  arrange() {}

  /** @param {boolean} on  whether the time runs */
  run(on) {
    this.plays = on;
    this.play.textContent = on ? '■' : '▶';
    this.last = performance.now();
    if (on) this.ask();
  }

  ask() {
    if (this.asked) return;
    this.asked = requestAnimationFrame((now) => {
      this.asked = 0;
      if (this.plays) {
        this.time += Math.min((now - this.last) / 1000, 0.25);
        this.last = now;
      }
      this.frame();
      if (this.plays) this.ask();
    });
  }

  frame() {
    const { gl, program, canvas } = this;
    if (!program || gl.isContextLost()) return;
    const scale = Math.min(devicePixelRatio, 2);
    const [width, height] = [Math.max(1, Math.round(this.root.clientWidth * scale)), Math.max(1, Math.round(this.root.clientHeight * scale))];
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.useProgram(program);
    const given = { time: [this.time], resolution: [width, height, 1], mouse: this.mouse, frame: [this.frames++], aspect: [width / height] };
    for (const [name, what] of Object.entries(this.picture.flat.given)) this.uniform(name, given[what]);
    for (const [name, numbers] of this.values) this.uniform(name, numbers);
    this.textures.forEach(({ name, dim, texture }, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(dim === '3D' ? gl.TEXTURE_3D : gl.TEXTURE_2D, texture);
      gl.uniform1i(gl.getUniformLocation(program, name), unit);
    });
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.clock.value = String(this.time % LONGEST);
    this.shownTime.textContent = `${this.time.toFixed(1)} s`;
    this.drawn += 1;
    this.drafts.sharp = true;
  }

  /** Sets a uniform as its own type in the program asks: the first numbers, as whole ones for whole types.
   * @param {string} name @param {number[]} numbers */
  uniform(name, numbers) {
    const { gl, program } = this;
    const place = program && gl.getUniformLocation(program, name);
    if (!place) return;
    let types = this.types.get(program);
    if (!types) {
      const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
      const rows = Array.from({ length: count }, (_, index) => gl.getActiveUniform(program, index));
      types = new Map(rows.flatMap((row) => (row ? [[row.name, row.type]] : [])));
      this.types.set(program, types);
    }
    const type = types.get(name) ?? 0;
    const families = /** @type {[string, number[]][]} */ ([
      ['fv', [gl.FLOAT, gl.FLOAT_VEC2, gl.FLOAT_VEC3, gl.FLOAT_VEC4]],
      ['iv', [gl.INT, gl.INT_VEC2, gl.INT_VEC3, gl.INT_VEC4]],
      ['iv', [gl.BOOL, gl.BOOL_VEC2, gl.BOOL_VEC3, gl.BOOL_VEC4]],
      ['uiv', [gl.UNSIGNED_INT, gl.UNSIGNED_INT_VEC2, gl.UNSIGNED_INT_VEC3, gl.UNSIGNED_INT_VEC4]],
    ]);
    for (const [suffix, sizes] of families) {
      const size = sizes.indexOf(type) + 1;
      if (size) gl[`uniform${size}${suffix}`](place, numbers.slice(0, size));
    }
  }

  dispose() {
    if (this.asked) cancelAnimationFrame(this.asked);
    this.plays = false;
    this.sizes.disconnect();
    this.gl?.getExtension('WEBGL_lose_context')?.loseContext();
  }
}
