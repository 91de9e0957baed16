// Pages that follow a text, in panels: what they ask goes to the language server, and what they show comes from there.

const vscode = require('vscode');

/** @typedef {import('vscode-languageclient/node').LanguageClient} Client */
/** @typedef {{ kind: string, id: number, asked: object, at: number }} Heard */

/** A page of a text, or of a mechanism in it. */
class Panel {
  /**
   * @param {vscode.Uri} uri
   * @param {string | undefined} mechanism
   * @param {() => Client | undefined} client
   */
  constructor(uri, mechanism, client) {
    this.uri = uri;
    this.mechanism = mechanism;
    this.client = client;
    this.version = 0;
    const title = mechanism ?? uri.path.split('/').pop() ?? 'mechanism';
    const place = { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true };
    this.panel = vscode.window.createWebviewPanel('mechc.view', title, place, { enableScripts: true, retainContextWhenHidden: true, localResourceRoots: [] });
    this.panel.webview.onDidReceiveMessage((message) => this.heard(message));
  }

  /** The server may be another one by now. */
  async begin() {
    const page = await this.request('mechc/view/panel', {});
    if (page) {
      this.panel.webview.html = page.html;
    }
  }

  /** Nobody looks any more. */
  end() {
    // a server that has ended knows of no page
    void this.client()?.sendNotification('mechc/view/close', this.meant()).catch(() => undefined);
  }

  meant() {
    return { textDocument: { uri: this.uri.toString() }, mechanism: this.mechanism ?? null };
  }

  /** @param {string} method @param {object} params @returns {Promise<any>} */
  request(method, params) {
    const client = this.client();
    const all = { ...this.meant(), ...params };
    return client ? client.sendRequest(method, all) : Promise.reject(new Error('mechc does not run'));
  }

  /** @param {Heard} message */
  async heard({ kind, id, asked, at }) {
    if (kind === 'ready') {
      this.post({ kind: 'state', state: 'there' });
      this.tell(this.version || 1, null);
    } else if (kind === 'show') {
      await this.show(at);
    } else if (kind === 'ask' || kind === 'write') {
      await this.request(`mechc/view/${kind}`, { asked }).then(
        (answer) => this.post({ kind: 'answer', id, data: kind === 'ask' ? bytesOf(answer.data) : answer }),
        (fault) => this.post({ kind: 'failed', id, why: String(fault) }),
      );
    }
  }

  /** @param {number} version @param {number | null} at @param {string | null} file in which that is, if not in its own */
  tell(version, at, file = null) {
    this.version = version;
    this.post({ kind: 'news', version, at, file });
  }

  /** @param {object} message */
  post(message) {
    void this.panel.webview.postMessage(message);
  }

  /** The place of the text that was chosen in the page. @param {number} at */
  async show(at) {
    const shown = vscode.window.visibleTextEditors.find(({ document }) => document.uri.toString() === this.uri.toString());
    const column = shown?.viewColumn ?? vscode.ViewColumn.One;
    const editor = await vscode.window.showTextDocument(this.uri, { viewColumn: column, preserveFocus: true });
    const place = editor.document.positionAt(at);
    editor.selection = new vscode.Selection(place, place);
    editor.revealRange(new vscode.Range(place, place), vscode.TextEditorRevealType.InCenterIfOutsideViewport);
  }
}

/** @param {string} text Base64 */
function bytesOf(text) {
  const bytes = Buffer.from(text, 'base64');
  return bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.byteLength);
}

/** All pages. */
class Panels {
  /** @param {() => Client | undefined} client */
  constructor(client) {
    this.client = client;
    /** @type {Panel[]} */
    this.open = [];
  }

  /** @param {vscode.Uri} uri @param {string | undefined} mechanism */
  async show(uri, mechanism) {
    const known = this.open.find((panel) => panel.uri.toString() === uri.toString() && panel.mechanism === mechanism);
    if (known) {
      known.panel.reveal(undefined, true);
      return;
    }
    const panel = new Panel(uri, mechanism, this.client);
    this.open.push(panel);
    panel.panel.onDidDispose(() => {
      this.open = this.open.filter((other) => other !== panel);
      panel.end();
    });
    await panel.begin();
  }

  /** A server has begun: it knows of no page yet. @param {Client} client */
  began(client) {
    client.onNotification('mechc/view/news', (/** @type {{ uri: string, version: number, at: number | null, file: string | null }} */ { uri, version, at, file }) => {
      for (const panel of this.of(uri)) {
        panel.tell(version, at, file);
      }
    });
    for (const panel of this.open) {
      void panel.begin();
    }
  }

  /** The cursor is elsewhere. @param {vscode.TextEditor} editor */
  point({ document, selection }) {
    for (const panel of this.of(document.uri.toString())) {
      panel.tell(panel.version, document.offsetAt(selection.active));
    }
    // which pages show a text that they use, the server knows
    if (document.languageId === 'mech' && this.open.length > this.of(document.uri.toString()).length) {
      const { line, character } = selection.active;
      void this.client()?.sendNotification('mechc/cursor', { textDocument: { uri: document.uri.toString() }, position: { line, character } }).catch(() => undefined);
    }
  }

  /** @param {string} uri */
  of(uri) {
    return this.open.filter((panel) => panel.uri.toString() === vscode.Uri.parse(uri).toString());
  }
}

module.exports = { Panels };
