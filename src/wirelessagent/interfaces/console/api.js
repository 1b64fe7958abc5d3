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

/** How a proxy says that there is no server behind it; the server itself says so by a problem document. */
const AWAY = new Set([502, 503, 504]);

const ROOT = new URL("../", import.meta.url);

/** The absolute address of a path of the interface: the console lies one folder below it. */
export const address = (at) => new URL(at, ROOT).href;

/** A path of the interface with ids in it. */
export const path = (parts, ...ids) => String.raw({ raw: parts }, ...ids.map(encodeURIComponent));

/** What was got before by its path, with the tag by which the server knows whether it still holds. */
const known = new Map();

async function call(method, at, { body = null, type = null, later = false } = {}) {
  const headers = { Accept: "application/json" };
  if (type) headers["Content-Type"] = type;
  if (later) headers.Prefer = "respond-async";
  const had = method === "GET" ? known.get(at) : null;
  if (had) headers["If-None-Match"] = had.tag;
  let answer;
  try {
    answer = await fetch(address(at), { method, headers, body, credentials: "same-origin" });
  } catch {
    throw new Disconnected(`✕ ${location.host}`);
  }
  const told = (answer.headers.get("Content-Type") ?? "").startsWith("application/problem+json");
  if (AWAY.has(answer.status) && !told) throw new Disconnected(`${answer.status} ${answer.statusText}`);
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
  if (tag) known.set(at, { tag, found });
  return found;
}

/** What is there: the same object as before where it has not changed. @param {string} at */
export const get = (at) => call("GET", at);
/** @param {string} at */
export const remove = (at) => call("DELETE", at);

/** Send JSON; with `later` long work is answered by a job. */
export const post = (at, fields = {}, later = false) =>
  call("POST", at, { body: JSON.stringify(fields), type: "application/json", later });

/** Put something in the place of what is there. */
export const put = (at, fields) => call("PUT", at, { body: JSON.stringify(fields), type: "application/json" });

/** Send a file as it is. */
export const upload = (at, file) => call("POST", at, { body: file, type: "application/octet-stream" });

/**
 * Have long work done and follow it to its end.
 * @param {string} at
 * @param {object|null} fields to be posted; null where it is only read
 * @param {(stage: object) => void} onStage
 */
export async function worked(at, fields, onStage) {
  const job = await (fields ? post(at, fields, true) : call("GET", at, { later: true }));
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
    const events = new EventSource(address(path`v1/jobs/${id}/events`));
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
    const job = await get(path`v1/jobs/${id}`);
    if (job.state === "done") return job.result;
    if (job.state === "cancelled") return null;
    if (job.state === "failed") throw new Problem(job.error);
    await new Promise((resolve) => setTimeout(resolve, 1000));
  }
}
