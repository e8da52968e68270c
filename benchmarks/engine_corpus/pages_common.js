// What the pages of the corpus share: they make an engine compile shaders, step by step, and post what was linked.

export const canvas = (width = 32, height = 32) => {
  const element = Object.assign(document.createElement('canvas'), { width, height });
  document.body.append(element);
  return element;
};

// A small picture as a data URL, for engines that load textures themselves.
export const picture = (() => {
  const element = Object.assign(document.createElement('canvas'), { width: 8, height: 8 });
  const context = element.getContext('2d');
  for (let index = 0; index < 64; index++) {
    context.fillStyle = `rgb(${index * 4}, ${255 - index * 3}, ${(index * 37) % 256})`;
    context.fillRect(index % 8, index >> 3, 1, 1);
  }
  return element.toDataURL();
})();

export const wait = (milliseconds) => new Promise((resolve) => setTimeout(resolve, milliseconds));

const LONGEST = 15_000; // milliseconds
let posted = 0;

async function post(message) {
  const programs = dumpedShaders.programs();
  await fetch('result', { method: 'POST', body: JSON.stringify({ programs: programs.slice(posted), ...message }) });
  posted = programs.length;
}

// Runs the steps, [name, function], and posts what each one linked. A step that throws does not stop the others.
export async function run(steps) {
  for (const [name, step] of steps) {
    try {
      await Promise.race([step(), wait(LONGEST).then(() => { throw new Error('it takes too long'); })]);
      await post({ step: name });
    } catch (error) {
      await post({ step: name, error: `${error?.stack ?? error}`.slice(0, 600) });
    }
  }
  await post({ done: true });
}
