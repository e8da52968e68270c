// What the page and Python say to each other, here over a web socket. Another transport has the same functions.

/** Connects the page: `heard` gets each message, `ended` is called when there is no more program to talk to.
 * @param {(message: any) => void} heard @param {() => void} ended */
export function connect(heard, ended) {
  const socket = new WebSocket(new URL('events', location.href).href.replace(/^http/, 'ws'));
  socket.binaryType = 'arraybuffer';
  socket.addEventListener('message', ({ data }) => heard(JSON.parse(data)));
  socket.addEventListener('close', ended);
  const open = () => socket.readyState === WebSocket.OPEN;
  return {
    /** @param {object} message */
    send(message) { if (open()) socket.send(JSON.stringify(message)); },

    /** A message with the bytes of a file: a line of JSON, then the bytes.
     * @param {object} message @param {File | ''} file */
    sendFile(message, file) { if (open()) socket.send(new Blob([`${JSON.stringify(message)}\n`, file])); },

    /** The triangles or texels with a digest.
     * @type {import('../page_messages.js').PieceOf} */
    async piece(digest) {
      const answer = await fetch(`piece/${digest}`);
      if (!answer.ok) throw new Error('the picture has changed meanwhile');
      return answer.arrayBuffer();
    },
  };
}
