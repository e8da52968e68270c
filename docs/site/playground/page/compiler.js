// The way to Python: at most one request is under way, and only the newest of those that wait is sent.

/** @typedef {{ request: object, resolve: (answer: any) => void, reject: (reason: Error) => void }} Request */

export class Compiler {
  /** `listener(kind, text)` is called with `started`, `ready` or `failed`.
   * @param {Worker} worker @param {(kind: string, text: string) => void} listener */
  constructor(worker, listener) {
    this.worker = worker;
    this.number = 0;
    /** @type {Request | null} */
    this.waiting = null;
    /** @type {Request | null} */
    this.asked = null;
    worker.addEventListener('message', ({ data }) => {
      if (data.kind === 'answer') this.answered(data); else listener(data.kind, data.text);
    });
    worker.addEventListener('error', (event) => listener('failed', event.message));
  }

  /** The answer; null for a request that a newer one has replaced.
   * @param {object} request @returns {Promise<any>} */
  ask(request) {
    return new Promise((resolve, reject) => {
      this.waiting?.resolve(null);
      this.waiting = { request, resolve, reject };
      this.send();
    });
  }

  send() {
    if (this.asked || !this.waiting) return;
    this.asked = this.waiting;
    this.waiting = null;
    this.worker.postMessage({ number: ++this.number, request: this.asked.request });
  }

  /** @param {{ answer: any, fault?: string }} data */
  answered({ answer, fault }) {
    const request = this.asked;
    this.asked = null;
    if (fault) request?.reject(new Error(fault)); else request?.resolve(answer);
    this.send();
  }
}
