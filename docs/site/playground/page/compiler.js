// The way to Python: at most one request is under way, and only the newest of those that wait is sent.

export class Compiler {
  /** `listener(kind, text)` is called with `started`, `ready` or `failed`. */
  constructor(worker, listener) {
    this.worker = worker;
    this.number = 0;
    this.waiting = null;
    this.asked = null;
    worker.addEventListener('message', ({ data }) => {
      if (data.kind === 'answer') this.answered(data); else listener(data.kind, data.text);
    });
    worker.addEventListener('error', (event) => listener('failed', event.message));
  }

  /** The answer; null for a request that a newer one has replaced. */
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

  answered({ answer, fault }) {
    const { resolve, reject } = this.asked;
    this.asked = null;
    if (fault) reject(new Error(fault)); else resolve(answer);
    this.send();
  }
}
