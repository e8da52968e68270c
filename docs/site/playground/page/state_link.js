// The whole state as the fragment of a link: it never reaches a server.

/** @param {BlobPart} data @param {CompressionStream | DecompressionStream} stream */
const codec = async (data, stream) => new Uint8Array(await new Response(new Blob([data]).stream().pipeThrough(stream)).arrayBuffer());
const LONGEST = 1 << 20;

/** A state as text for a link: JSON, deflated, in base64 for URLs.
 * @param {object} state */
export async function packedState(state) {
  const bytes = await codec(new TextEncoder().encode(JSON.stringify(state)), new CompressionStream('deflate-raw'));
  const text = Array.from(bytes, (byte) => String.fromCharCode(byte)).join('');
  return btoa(text).replaceAll('+', '-').replaceAll('/', '_').replaceAll('=', '');
}

/** The state of a link's text. Throws for a text that is none.
 * @param {string} text */
export async function unpackedState(text) {
  if (text.length > LONGEST) throw new Error('the link is too long');
  const bytes = Uint8Array.from(atob(text.replaceAll('-', '+').replaceAll('_', '/')), (letter) => letter.charCodeAt(0));
  return JSON.parse(new TextDecoder().decode(await codec(bytes, new DecompressionStream('deflate-raw'))));
}
