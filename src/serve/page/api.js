// serve/page/api.js - talks to the server: token, calls, uploads, and a view whose pictures arrive.
// SPDX-License-Identifier: Apache-2.0

const tokenKey = "obscura-token";
const fileKey = "obscura-file";
const retryMs = 1000;
const longestWaitMs = 100;

/** What the server, or the way to it, says against a call. */
export class Problem extends Error {
  constructor(status, {id, place = "", text, also = []}) {
    super(text);
    Object.assign(this, {status, id, place, also});
  }
}

/**
 * Moves the token from the address, where it would be seen and shared, to this tab's storage. Gives
 * the file to open: the address' one, or that which was open before the page was reloaded.
 */
export function takeFragment() {
  const fragment = new URLSearchParams(location.hash.slice(1));
  const isNew = location.hash || performance.getEntriesByType("navigation")[0]?.type === "navigate";
  if (fragment.has("token")) setToken(fragment.get("token"));
  if (isNew) rememberFile(fragment.get("file"));
  if (location.hash) history.replaceState(null, "", location.pathname);
  return sessionStorage.getItem(fileKey);
}

/** For when the page is reloaded; null: none. */
export function rememberFile(file) {
  if (file === null) sessionStorage.removeItem(fileKey);
  else sessionStorage.setItem(fileKey, file);
}

export function setToken(token) {
  sessionStorage.setItem(tokenKey, token);
}

export function hasToken() {
  return sessionStorage.getItem(tokenKey) !== null;
}

/** Without a token for servers that ask for none; others answer 401. */
function authorization() {
  return hasToken() ? `Bearer ${sessionStorage.getItem(tokenKey)}` : "";
}

function problemOf(status, text) {
  try {
    const answer = JSON.parse(text);
    const {serial, wish} = answer;
    return Object.assign(new Problem(status, answer.error), {serial, wish});
  } catch {
    return new Problem(status, {id: `HTTP ${status}`, text: text || "the server gave no reason"});
  }
}

function unreachable() {
  return new Problem(0, {id: "offline", text: "The server does not answer. Is it still running?"});
}

/** The response to a call below /api/; throws a Problem, or AbortError when it was given up. */
export async function call(path, {method = "GET", json, signal} = {}) {
  const headers = {Authorization: authorization()};
  if (json) headers["Content-Type"] = "application/json";
  const request = {method, headers, signal, body: json && JSON.stringify(json), cache: "no-store"};
  const response = await fetch(`/api/${path}`, request).catch((error) => {
    throw error.name === "AbortError" ? error : unreachable();
  });
  if (!response.ok) throw problemOf(response.status, await response.text());
  return response;
}

export async function callJson(path, request) {
  return (await call(path, request)).json();
}

/** Raw pixels with what the header says of them. */
async function pixelsOf(response) {
  const picture = JSON.parse(response.headers.get("X-Obscura-Image"));
  const body = response.arrayBuffer().catch(() => { throw unreachable(); });
  picture.bytes = new Uint8Array(await body);
  return picture;
}

/** Sends a file; `onProgress` hears which share of it has gone. Only XMLHttpRequest tells. */
export function upload(file, onProgress) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    request.open("POST", `/api/files?name=${encodeURIComponent(file.name)}`);
    request.setRequestHeader("Authorization", authorization());
    request.setRequestHeader("Content-Type", "application/octet-stream");
    request.upload.onprogress = (event) => onProgress(event.loaded / event.total);
    request.onerror = () => reject(unreachable());
    request.onload = () => {
      if (request.status === 201) resolve(JSON.parse(request.responseText).file);
      else reject(problemOf(request.status, request.responseText));
    };
    request.send(file);
  });
}

function pause(ms) {
  return new Promise((resolve) => setTimeout(resolve, ms));
}

/**
 * A file opened on the server. Wishes go out one at a time, each once the one before was seen or
 * took long, so that a hand that never rests sees all it does; of those that wait only the newest
 * goes. Pictures come in by one long poll. `listener` has onCommand(command), onImage(picture),
 * onGone() and onProblem(source, problem), with null once the problem of that source is solved.
 */
export class View {
  static async open(file, listener) {
    const answer = await callJson("views", {method: "POST", json: {file}});
    return new View(file, answer, listener);
  }

  constructor(file, answer, listener) {
    this.file = file;
    this.asset = answer.asset;
    this.camera = answer.camera;
    this.path = `views/${answer.view}`;
    this.listener = listener;
    this.life = new AbortController();
    this.wish = 0;
    this.shown = 0;
    this.poll();
  }

  get isClosed() {
    return this.life.signal.aborted;
  }

  /** Are the pictures that arrive still those of an earlier wish? */
  get isBehind() {
    return Boolean(this.waiting) || this.isAsking || this.shown < this.wish;
  }

  close() {
    if (this.isClosed) return;
    this.life.abort();
    call(this.path, {method: "DELETE"}).catch(() => {});  // it may be gone already
  }

  /** Wishes for a picture; false if it is the one that is on its way already. */
  put(options) {
    if (this.isClosed) return false;
    const text = JSON.stringify(options);
    if (text === this.sent && !this.isSending) return false;
    this.waiting = text;
    if (!this.isSending) this.send();
    return true;
  }

  async send() {
    this.isSending = true;
    while (this.waiting && !this.isClosed) {
      const text = this.waiting;
      this.waiting = null;
      if (text === this.sent) continue;
      await this.sendOne(text);
      await this.firstImage();
    }
    this.isSending = false;
  }

  firstImage() {
    return new Promise((resolve) => {
      if (this.shown >= this.wish) return resolve();
      this.onShown = resolve;
      setTimeout(resolve, longestWaitMs);
    });
  }

  async sendOne(text) {
    this.isAsking = true;
    try {
      const request = {method: "PUT", json: {options: JSON.parse(text)}, signal: this.life.signal};
      const answer = await callJson(this.path, request);
      this.sent = text;
      this.wish = answer.wish;
      this.listener.onProblem("wish", null);
      this.listener.onCommand(answer.command);
    } catch (error) {
      this.sent = null;
      this.report("wish", error);
      if (error.status === 0) {
        await pause(retryMs);
        this.waiting ??= text;
      }
    } finally {
      this.isAsking = false;
    }
  }

  report(source, error) {
    if (this.isClosed) return;
    if (!(error instanceof Problem)) throw error;
    if (error.status !== 0) this.listener.onProblem("server", null);
    if (error.id === "E-SERVE-UNKNOWN") {  // others are of files that the wish names
      this.life.abort();
      this.listener.onGone();
    } else {
      this.listener.onProblem(error.status === 0 ? "server" : source, error);
    }
  }

  async poll() {
    let serial = 0;
    while (!this.isClosed) {
      try {
        serial = await this.next(serial);
      } catch (error) {
        this.report("picture", error);
        if (error.serial) {
          serial = error.serial;
          this.shown = Math.max(this.shown, error.wish);
        } else {
          await pause(retryMs);
        }
      }
    }
  }

  /** Waits for news after a serial and returns the serial of what came. */
  async next(serial) {
    const request = {signal: this.life.signal};
    const response = await call(`${this.path}/picture?after=${serial}`, request);
    this.listener.onProblem("server", null);
    if (response.status === 204) return serial;
    const picture = await pixelsOf(response);
    if (!this.isClosed && picture.wish >= this.shown) {
      this.shown = picture.wish;
      if (picture.wish >= this.wish) this.listener.onProblem("picture", null);
      this.listener.onImage(picture);
      if (picture.wish >= this.wish) this.onShown?.();
    }
    return picture.serial;
  }

  pick(x, y) {
    return callJson(`${this.path}/pick?x=${x.toFixed(5)}&y=${y.toFixed(5)}`);
  }

  async matte(node) {
    return pixelsOf(await call(`${this.path}/matte?node=${encodeURIComponent(node)}`));
  }

  /** The picture as a file, once it is that of the latest wish. */
  async image(format) {
    while (this.isBehind && !this.isClosed) await pause(retryMs / 20);
    for (;;) {
      try {
        return (await call(`${this.path}/image?format=${format}`)).blob();
      } catch (error) {
        if (error.id !== "E-VIEW-EMPTY" || this.isClosed) throw error;
        await pause(retryMs / 4);
      }
    }
  }
}
