// The picture of plain GLSL: its translation to GLSL ES 3.00 on the whole canvas, with the values that Shadertoy gives.

const VERTEX = `#version 300 es
void main() { gl_Position = vec4(vec2(gl_VertexID & 1, gl_VertexID >> 1) * 4.0 - 1.0, 0.0, 1.0); }`;

export class PlainStage {
  constructor(root) {
    this.root = root;
    this.canvas = document.createElement('canvas');
    root.replaceChildren(this.canvas);
    this.gl = this.canvas.getContext('webgl2', { preserveDrawingBuffer: true });
    this.began = performance.now();
    this.mouse = [0, 0, 0, 0];
    this.canvas.addEventListener('pointermove', (event) => {
      if (!event.buttons) return;
      const box = this.canvas.getBoundingClientRect();
      const place = [event.clientX - box.left, box.bottom - event.clientY].map((length) => length * devicePixelRatio);
      this.mouse = [...place, ...place];
    });
  }

  /** Draws a fragment shader from now on; returns '' or the driver's message, and the last picture stays. */
  show(text) {
    if (!this.gl) return 'this browser has no WebGL 2';
    const { gl } = this;
    const program = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, VERTEX], [gl.FRAGMENT_SHADER, text]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      gl.deleteShader(shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      const message = gl.getAttachedShaders(program).map((shader) => gl.getShaderInfoLog(shader)).join('').trim();
      gl.deleteProgram(program);
      return `it is no fragment shader that this page can draw: ${message || gl.getError()}`;
    }
    gl.deleteProgram(this.program ?? null);
    this.program = program;
    if (!this.asked) this.frame();
    return '';
  }

  frame() {
    const { gl } = this;
    const [width, height] = [this.root.clientWidth * devicePixelRatio, this.root.clientHeight * devicePixelRatio].map(Math.round);
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    gl.viewport(0, 0, width, height);
    gl.useProgram(this.program);
    const time = (performance.now() - this.began) / 1000;
    const day = new Date();
    const set = (name, method, ...numbers) => {
      const place = gl.getUniformLocation(this.program, name);
      if (place) gl[method](place, ...numbers);
    };
    set('iResolution', 'uniform3f', width, height, 1);
    set('iTime', 'uniform1f', time);
    set('iTimeDelta', 'uniform1f', 1 / 60);
    set('iFrameRate', 'uniform1f', 60);
    set('iFrame', 'uniform1i', Math.round(time * 60));
    set('iMouse', 'uniform4f', ...this.mouse);
    set('iDate', 'uniform4f', day.getFullYear(), day.getMonth(), day.getDate(), (day.getHours() * 60 + day.getMinutes()) * 60 + day.getSeconds());
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.drawn = (this.drawn ?? 0) + 1;
    this.asked = requestAnimationFrame(() => this.frame());
  }

  dispose() {
    cancelAnimationFrame(this.asked);
    this.gl?.getExtension('WEBGL_lose_context')?.loseContext();
    this.canvas.remove();
  }
}
