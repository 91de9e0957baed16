// A client says itself that its server does not start; so does the extension, with a button that helps. One of them is enough.

/**
 * A kind of client that shows no messages of its own while it starts: whoever starts it is told. The output has them still.
 * @template {new (...given: any[]) => { error(message: string, data?: any, shown?: boolean | 'force'): void, start(): Promise<void> }} T
 * @param {T} Client
 */
function quietAtStart(Client) {
  return class extends Client {
    starting = false;

    async start() {
      this.starting = true;
      try {
        await super.start();
      } finally {
        this.starting = false;
      }
    }

    /** @param {string} message @param {any} [data] @param {boolean | 'force'} [shown] */
    error(message, data, shown) {
      super.error(message, data, this.starting ? false : shown);
    }
  };
}

module.exports = { quietAtStart };
