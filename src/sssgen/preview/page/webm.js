// A WebM file of one track of frames (RFC 8794, EBML; RFC 9559, Matroska).

/** @typedef {{ data: Uint8Array, time: number, key: boolean }} Block  A coded frame; `time` in seconds. */

const ID = {
  ebml: 0x1a45dfa3, version: 0x4286, readVersion: 0x42f7, idLength: 0x42f2, sizeLength: 0x42f3, docType: 0x4282, docVersion: 0x4287,
  docReadVersion: 0x4285, segment: 0x18538067, info: 0x1549a966, scale: 0x2ad7b1, duration: 0x4489, muxer: 0x4d80, writer: 0x5741,
  tracks: 0x1654ae6b, track: 0xae, number: 0xd7, uid: 0x73c5, type: 0x83, codec: 0x86, lacing: 0x9c, frameDuration: 0x23e383, video: 0xe0,
  width: 0xb0, height: 0xba, cues: 0x1c53bb6b, cue: 0xbb, cueTime: 0xb3, cuePlace: 0xb7, cueTrack: 0xf7, cueCluster: 0xf1,
  cluster: 0x1f43b675, clusterTime: 0xe7, block: 0xa3,
};
const TICKS = 1000;  // in a second

/** @param {number} number  a whole one, at least 0 @param {number} [length]  in bytes, if not the least */
function bytesOf(number, length = 0) {
  const bytes = [];
  for (let rest = number; rest > 0 || bytes.length < (length || 1); rest = Math.floor(rest / 256)) bytes.unshift(rest % 256);
  return new Uint8Array(bytes);
}

/** @param {number} number */
function realOf(number) {
  const bytes = new Uint8Array(8);
  new DataView(bytes.buffer).setFloat64(0, number);
  return bytes;
}

const textOf = (/** @type {string} */ text) => new TextEncoder().encode(text);

/** @param {Uint8Array[]} parts */
function joined(parts) {
  const result = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  let at = 0;
  for (const part of parts) { result.set(part, at); at += part.length; }
  return result;
}

/** An element: its ID, its size in eight bytes, its content.
 * @param {number} id @param {Uint8Array[]} content */
function element(id, ...content) {
  const size = bytesOf(content.reduce((sum, part) => sum + part.length, 0), 8);
  size[0] = 1;  // which says that there are eight
  return joined([bytesOf(id), size, ...content]);
}

/** The file. The frames are in order, the first is a key frame; each key frame begins a cluster, which a player can seek.
 * @param {Block[]} blocks @param {{ width: number, height: number, rate: number, count: number, codec: string }} film */
export function webmOf(blocks, { width, height, rate, count, codec }) {
  const number = (/** @type {number} */ id, /** @type {number} */ value, length = 0) => element(id, bytesOf(value, length));
  const head = element(ID.ebml, number(ID.version, 1), number(ID.readVersion, 1), number(ID.idLength, 4), number(ID.sizeLength, 8),
    element(ID.docType, textOf('webm')), number(ID.docVersion, 4), number(ID.docReadVersion, 2));
  const info = element(ID.info, number(ID.scale, 1e9 / TICKS), element(ID.duration, realOf(TICKS * count / rate)),
    element(ID.muxer, textOf('sssgen')), element(ID.writer, textOf('sssgen preview')));
  const tracks = element(ID.tracks, element(ID.track, number(ID.number, 1), number(ID.uid, 1), number(ID.type, 1), number(ID.lacing, 0),
    element(ID.codec, textOf(codec)), number(ID.frameDuration, Math.round(1e9 / rate)),
    element(ID.video, number(ID.width, width), number(ID.height, height))));
  const clusters = clustersOf(blocks);
  const cuesFrom = (/** @type {number} */ start) => {
    let at = start;
    return element(ID.cues, ...clusters.map(({ time, data }) => {
      const cue = element(ID.cue, number(ID.cueTime, time, 8), element(ID.cuePlace, number(ID.cueTrack, 1), number(ID.cueCluster, at, 8)));
      at += data.length;
      return cue;
    }));
  };
  const before = info.length + tracks.length;
  const cues = cuesFrom(before + cuesFrom(0).length);  // its length does not depend on the places
  return joined([head, element(ID.segment, info, tracks, cues, ...clusters.map(({ data }) => data))]);
}

/** @param {Block[]} blocks */
function clustersOf(blocks) {
  /** @type {{ time: number, parts: Uint8Array[] }[]} */
  const clusters = [];
  for (const { data, time, key } of blocks) {
    const ticks = Math.round(TICKS * time);
    if (key) clusters.push({ time: ticks, parts: [] });
    const cluster = clusters[clusters.length - 1];
    const off = bytesOf(ticks - cluster.time, 2);
    cluster.parts.push(element(ID.block, new Uint8Array([0x81, ...off, key ? 0x80 : 0]), data));
  }
  return clusters.map(({ time, parts }) => ({ time, data: element(ID.cluster, element(ID.clusterTime, bytesOf(time)), ...parts) }));
}
