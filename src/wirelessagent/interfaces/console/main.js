/** The console: one state, drawn whole when it changes, refreshed quietly from the server. */

import { drawAllocation } from "./allocation.js";
import { Disconnected, Problem, follow, get, path, post, remove } from "./api.js";
import { drawCells, setUpNewCell } from "./cells.js";
import { drawCertificate, drawPrices } from "./certificate.js";
import { drawChannel } from "./channel.js";
import { openComparison } from "./compare.js";
import { drawConversation, giveBack, setUpConversation } from "./conversation.js";
import { byId } from "./dom.js";
import { drawExport, setUpReport } from "./exporting.js";
import { nameRecognisers } from "./forms.js";
import { drawPlan } from "./plan.js";
import { drawRates } from "./rates.js";
import { setUpTools } from "./tools.js";
import { setUpLanguages, setUpTheme, wantedLanguage } from "./settings.js";
import { scene, state } from "./state.js";
import { drawTimeline } from "./timeline.js";
import { openTradeOff } from "./trade-off.js";
import { inShort, isUsable, saidFor, turnOf } from "./turns.js";
import { nameUnits, setUpUpload } from "./upload.js";
import { say, speak, trouble } from "./words.js";

const CELL = "wirelessagent.cell";
const EVERY_MS = 4000;
const LONGEST_MS = 15000;
const CALMER = 1.25;
const JOB = "wirelessagent.job";

let drawn = [];
let wait = EVERY_MS;
let timer = 0;

function shownName({ shown, planTurn, effect }) {
  if (shown === effect || !isUsable(shown)) return say("console.in_effect");
  return shown === planTurn ? say("console.plan") : say("turn.column", { number: shown?.number });
}

function draw() {
  if (!state.session) return;
  const now = scene();
  const usable = [now.shown, now.effect].find(isUsable) ?? null;
  byId("page").classList.toggle("loading", false);
  byId("looking").hidden = !now.looked;
  if (now.looked) byId("looking-text").textContent = say("console.looking", { number: now.looked.number, text: saidFor(state.session, now.looked) });
  drawConversation(state, now, actions);
  const { lang, dataset } = document.documentElement;
  const asIs = [state.session, state.channel, state.looking, now.busy, now.stale, state.cell, lang, dataset.theme];
  if (asIs.every((one, place) => one === drawn[place])) return;
  drawn = asIs;
  drawPlan(now, actions);
  drawCells(state.console.cells, state.cell, now.canAct, actions);
  drawChannel(state.channel);
  drawAllocation(usable, now.effect, shownName(now));
  drawRates(usable);
  drawCertificate(now.shown);
  byId("trade-off-open").hidden = !now.shown?.decision;
  drawPrices(now.shown);
  drawTimeline(state.session, now, actions);
  drawExport(now.shown, fail);
  const inEffect = now.effect ? [inShort(now.effect), now.people && now.effect.by].filter(Boolean).join(" · ") : "";
  byId("in-effect").textContent = inEffect
    ? say("console.in_effect_is", { what: inEffect }) : say("console.nothing_in_effect");
  byId("in-effect").classList.toggle("on", Boolean(now.effect));
  byId("return").hidden = !now.canAct || now.looked === now.effect;
}

/** Whether a problem leads to the sign-in page. */
function signsIn(problem) {
  const away = problem instanceof Problem && problem.status === 401;
  if (away) location.href = "sign-in.html";
  return away;
}

function fail(problem) {
  if (problem instanceof Disconnected) return connected(false);
  if (signsIn(problem)) return;
  state.problem = problem;
  draw();
}

function connected(is) {
  if (state.connected !== is) announce(is ? say("console.connected_again") : say("console.disconnected"));
  state.connected = is;
  byId("disconnected").hidden = is;
}

/** Tell those who listen to the page something that shows elsewhere. */
const announce = (text) => { byId("announced").textContent = text; };

/** Fetch the session, and the channel where turns came, and draw what changed. */
async function refresh() {
  const { session: before } = state;
  const cells = await get("v1/cells");
  const cell = cells.find((one) => one.id === state.cell.id);
  if (!cell) return reload(null);
  const session = await get(path`v1/sessions/${cell.session}`);
  if (session.cell !== state.cell.id) return;
  state.console.cells = cells;
  state.cell = cell;
  wait = session === before ? Math.min(LONGEST_MS, wait * CALMER) : EVERY_MS;
  const came = session.id !== before?.id || session.turns.length !== before.turns.length;
  if (came) state.channel = await get(path`v1/sessions/${session.id}/channel`);
  if (before && came && session.id === before.id && session.in_effect !== before.in_effect) {
    const applied = turnOf(session, session.in_effect);
    if (applied) announce(say("console.applied_by", { who: applied.by ?? "–", what: inShort(applied) }));
  }
  const last = session.turns.at(-1);
  if (came && state.job && last?.stage === "answered" && isUsable(last)) state.looking = last.number; // one's what-if shows itself
  state.session = session;
  draw();
}

async function tick() {
  clearTimeout(timer);
  if (!document.hidden && state.cell) {
    try {
      await refresh();
      connected(true);
    } catch (problem) {
      if (!(problem instanceof Disconnected)) fail(problem);
      else {
        wait = state.connected ? 1000 : Math.min(LONGEST_MS, wait * 2);
        connected(false);
      }
    }
  }
  timer = setTimeout(tick, wait);
}

/** Follow a job to its end, stages as they come. */
async function work(id, text) {
  state.job = { id, text, stages: [] };
  sessionStorage.setItem(JOB, JSON.stringify({ id, text, session: state.session.id }));
  draw();
  try {
    await follow(id, (stage) => {
      const { stages } = state.job;
      if (stages.at(-1)?.stage === stage.stage && stage.total > 1) stages.pop();
      stages.push(stage);
      draw();
    });
  } catch (problem) {
    fail(problem);
    giveBack(text);
  }
  sessionStorage.removeItem(JOB);
  wait = EVERY_MS;
  await tick();
  state.job = null;
  draw();
  if (document.activeElement === document.body) byId("log").focus({ preventScroll: true }); // its button went
}

/** Begin something that a job answers; whether it was taken. */
async function begin(what, fields, text) {
  if (state.job) return false;
  state.problem = null;
  try {
    const job = await post(path`v1/sessions/${state.session.id}/${what}`, fields, true);
    connected(true);
    state.looking = null;
    work(job.id, text);
    return true;
  } catch (problem) {
    fail(problem);
    tick();
    return false;
  }
}

/** Words apply nothing: a yes or no to the plan that waits leads to its button. */
function toButton(text) {
  if (byId("plan-card").hidden) return false;
  const place = ["pressed.yes", "pressed.no"].findIndex((key) => say(key).toLowerCase() === text.toLowerCase());
  const button = byId("plan").querySelectorAll(".buttons button")[place];
  button?.focus();
  return Boolean(button);
}

const actions = {
  send: (text) => toButton(text) || begin("turns", { text }, text),
  apply: () => begin("confirm", { plan: state.session.plan.id }, ""),
  discard: () => begin("discard", { plan: state.session.plan.id }, ""),
  back: (number) => actions.send(say("console.say_back", { number })),
  cancel: () => remove(path`v1/jobs/${state.job.id}`).catch(fail),
  dismiss() {
    state.problem = null;
    draw();
  },
  look(number) {
    const now = scene();
    const isNow = number === null || turnOf(state.session, number) === (now.planTurn ?? now.effect);
    state.looking = isNow ? null : number;
    draw();
    byId("pictures").scrollIntoView({ block: "nearest" });
  },
  compare: (turns) => openComparison(state.session, turns),
  pick: choose,
};

/** Look at another cell. */
async function choose(id) {
  const { cells } = state.console;
  state.cell = cells.find((cell) => cell.id === id) ?? cells.find((cell) => cell.demonstration) ?? cells[0] ?? null;
  byId("no-cell").hidden = Boolean(state.cell);
  for (const part of ["page", "cells"]) byId(part).hidden = !state.cell;
  if (!state.cell) return;
  Object.assign(state, { session: null, channel: null, looking: null, job: null, problem: null });
  localStorage.setItem(CELL, state.cell.id);
  byId("cells").open = false;
  byId("page").classList.add("loading");
  await tick();
  takeUp();
}

/** Go on with a job that was under way when the page was left. */
async function takeUp() {
  const left = JSON.parse(sessionStorage.getItem(JOB) ?? "null");
  if (!left || left.session !== state.session?.id) return;
  const job = await get(path`v1/jobs/${left.id}`).catch(() => null);
  if (job?.state === "running") work(left.id, left.text);
  else sessionStorage.removeItem(JOB);
}

async function reload(id) {
  state.console = await get("v1/console");
  await choose(id);
}

function setUpDialogs() {
  for (const button of document.querySelectorAll("[data-open]")) {
    button.addEventListener("click", () => byId(button.dataset.open).showModal());
  }
  for (const button of document.querySelectorAll("[data-close]")) {
    button.addEventListener("click", () => button.closest("dialog").close());
  }
  document.addEventListener("click", (event) => {
    for (const menu of document.querySelectorAll("details.menu[open]")) if (!menu.contains(event.target)) menu.open = false;
  });
  document.addEventListener("keydown", (event) => {
    const menu = event.key === "Escape" && document.querySelector("details.menu[open]");
    if (!menu) return;
    menu.open = false;
    menu.querySelector("summary").focus();
  });
}

function setUp() {
  setUpDialogs();
  setUpReport();
  setUpConversation(actions);
  setUpTheme(draw);
  setUpTools(() => ({ cell: state.cell, channel: state.channel, cells: state.console.cells }));
  setUpUpload({ made: (cell) => reload(cell.id).catch(fail), cell: () => state.cell, allowed: () => state.console.role === "operator" });
  setUpNewCell((cell) => {
    byId("settings").close();
    reload(cell.id).catch(fail);
  });
  const clicks = {
    now: () => actions.look(null),
    return: () => actions.back(state.looking),
    "sign-out": () => post("sign-out").then(() => { location.href = "sign-in.html"; }).catch(fail),
    retry: tick,
    "cell-new-talk": () => post("v1/sessions", { cell: state.cell.id }).then(() => reload(state.cell.id)).catch(fail),
    "trade-off-open": () => openTradeOff(state.session.id, scene().shown, state.cell.max_power_w),
    "remove-yes"() {
      byId("remove").close();
      remove(path`v1/cells/${state.cell.id}`).then(() => reload(null)).catch(fail);
    },
  };
  for (const [id, act] of Object.entries(clicks)) byId(id).addEventListener("click", act);
  document.addEventListener("visibilitychange", () => document.hidden || tick());
  window.addEventListener("online", tick);
}

async function start() {
  byId("broken").hidden = true;
  try {
    state.console = await get("v1/console");
    const { languages, signed_in: signedIn } = state.console;
    const wanted = wantedLanguage(languages);
    await speak(wanted);
    document.body.classList.remove("bare");
    const nameChoices = () => {
      nameUnits();
      nameRecognisers(state.console.llm);
    };
    nameChoices();
    setUpLanguages(languages, wanted, async (tag) => {
      await speak(tag);
      nameChoices();
      draw();
    });
    document.body.classList.toggle("viewer", state.console.role !== "operator");
    byId("sign-out").hidden = !signedIn;
    byId("version").textContent = state.console.version;
    setUp();
    await choose(localStorage.getItem(CELL));
  } catch (problem) {
    if (signsIn(problem)) return;
    byId("broken").hidden = false;
    byId("broken-text").textContent = trouble(problem);
    setTimeout(start, EVERY_MS);
  }
}

start();
