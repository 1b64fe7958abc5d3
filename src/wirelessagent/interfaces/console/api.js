/** The REST interface, the only place that speaks to the server. All paths are relative to where the server is mounted. */

/** An answer that is a problem document (RFC 9457). */
export class Problem extends Error {
  constructor({ title, detail, status }) {
    super(detail || title || String(status));
    this.title = title;
    this.status = status;
  }
}

/** The server cannot be reached. */
export class Disconnected extends Error {}

const AWAY = new Set([502, 503, 504]);

const ROOT = new URL("../", import.meta.url);

/** The absolute address of a path of the interface: the console lies one folder below it. */
export const address = (path) => new URL(path, ROOT).href;

/** What was got before by its path, with the tag by which the server knows whether it still holds. */
const known = new Map();

async function call(method, path, { body = null, type = null, later = false } = {}) {
  const headers = { Accept: "application/json" };
  if (type) headers["Content-Type"] = type;
  if (later) headers.Prefer = "respond-async";
  const had = method === "GET" ? known.get(path) : null;
  if (had) headers["If-None-Match"] = had.tag;
  let answer;
  try {
    answer = await fetch(address(path), { method, headers, body, credentials: "same-origin" });
  } catch {
    throw new Disconnected("…");
  }
  if (AWAY.has(answer.status)) throw new Disconnected(`${answer.status} ${answer.statusText}`);
  if (answer.status === 304) return had.found;
  const text = await answer.text();
  let found = null;
  try {
    found = text ? JSON.parse(text) : null;
  } catch {
    if (answer.ok) throw new Problem({ status: answer.status, detail: text.slice(0, 200) });
  }
  if (!answer.ok) throw new Problem({ status: answer.status, ...(found ?? { title: answer.statusText }) });
  const tag = answer.headers.get("ETag");
  if (tag) known.set(path, { tag, found });
  return found;
}

/** What is there: the same object as before where it has not changed. @param {string} path */
export const get = (path) => call("GET", path);
/** @param {string} path */
export const remove = (path) => call("DELETE", path);

/** Send JSON; with `later` long work is answered by a job. */
export const post = (path, fields = {}, later = false) =>
  call("POST", path, { body: JSON.stringify(fields), type: "application/json", later });

/** Send a file as it is. */
export const upload = (path, file) => call("POST", path, { body: file, type: "application/octet-stream" });

/**
 * Have long work done and follow it to its end.
 * @param {string} path
 * @param {object|null} fields to be posted; null where it is only read
 * @param {(stage: object) => void} onStage
 */
export async function worked(path, fields, onStage) {
  const job = await (fields ? post(path, fields, true) : call("GET", path, { later: true }));
  return job.state === "done" ? job.result : follow(job.id, onStage);
}

/**
 * Follow a job to its end: its events where they can be had, else by asking now and then.
 * The browser itself takes events up again after the last one that it saw.
 * @param {string} id
 * @param {(stage: {stage: string, label: string, message: string, done: number, total: number}) => void} onStage
 * @returns {Promise<object|null>} the result; null where the job was cancelled
 */
export function follow(id, onStage) {
  return new Promise((resolve, reject) => {
    const events = new EventSource(address(`v1/jobs/${encodeURIComponent(id)}/events`));
    const end = (settle, value) => {
      events.close();
      settle(value);
    };
    events.addEventListener("stage", (event) => onStage(JSON.parse(event.data)));
    events.addEventListener("done", (event) => end(resolve, JSON.parse(event.data)));
    events.addEventListener("failed", (event) => end(reject, new Problem(JSON.parse(event.data))));
    events.addEventListener("cancelled", () => end(resolve, null));
    events.addEventListener("error", () => {
      if (events.readyState === EventSource.CLOSED) poll(id).then(resolve, reject);
    });
  });
}

async function poll(id) {
  for (;;) {
    const job = await get(`v1/jobs/${encodeURIComponent(id)}`);
    if (job.state === "done") return job.result;
    if (job.state === "cancelled") return null;
    if (job.state === "failed") throw new Problem(job.error);
    await new Promise((resolve) => setTimeout(resolve, 1000));
  }
}
