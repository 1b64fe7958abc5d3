/** The conversation: what was said, three lines for each answer with more behind a click, stages as they come, the input. */

import { button, byId, element, fillIfNew, table } from "./dom.js";
import { suggestions } from "./suggestions.js";
import { clock } from "./units.js";
import { say, stageName } from "./words.js";

const DRAFT = "wirelessagent.draft.";
const LINES = { decided: "console.decided", changed: "console.changed", needs: "console.needs" };
let drawnAs = "";
let drawnTurns = 0;
let draftKey = "";

function more(turn) {
  const parts = [
    ...turn.explanation.map((sentence) => element("p", {}, sentence)),
    ...(turn.notes.length ? [element("ul", {}, turn.notes.map((note) => element("li", {}, note)))] : []),
    ...turn.tables.map(table),
  ];
  return parts.length > 0 && element("details", {}, element("summary", {}, say("console.more")), element("div", { class: "more" }, parts));
}

function answered(turn, people, actions) {
  const asks = turn.stage === "asked";
  const lines = Object.keys(LINES).filter((name) => turn.lines[name]).map((name) => [
    element("dt", {}, say(name === "decided" && turn.stage === "answered" ? "console.answer" : LINES[name])),
    element("dd", { class: name === "needs" && asks ? "asks" : name }, turn.lines[name]),
  ]);
  return element("article", { class: "turn", id: `turn-${turn.number}`, "aria-label": say("turn.column", { number: turn.number }) },
    element("p", { class: "said" }, turn.text),
    element("p", { class: "by" }, [people && turn.by, clock(turn.at_utc)].filter(Boolean).join(" · ")),
    element("div", { class: asks ? "answer asked" : "answer", lang: turn.language ?? null },
      element("dl", {}, lines),
      element("div", { class: "foot" }, more(turn),
        turn.decision && button(() => actions.look(turn.number), { class: "link" }, say("console.show_pictures")),
        element("span", { class: `badge ${turn.stage}` }, stageName(turn.stage)))));
}

function working({ text, stages }, actions) {
  const counted = (stage) => (stage.total > 1 ? ` ${stage.done}/${stage.total}` : "");
  return [text && element("p", { class: "said" }, text),
    element("ul", { class: "stages" }, stages.map((stage) => element("li", {}, element("b", {}, stage.label), ` ${stage.message}${counted(stage)}`)),
      element("li", { class: "now" }, say("console.working"))),
    button(actions.cancel, { class: "link" }, say("console.cancel"))];
}

function failure(problem, actions) {
  return element("div", { class: "problem", role: "alert" }, element("b", {}, problem.title ?? say("console.failed")), element("p", {}, problem.message),
    button(actions.dismiss, { class: "link" }, say("console.dismiss")));
}

/**
 * Set up the input once.
 * @param {{send: (text: string) => Promise<boolean>}} actions `send` answers whether the line was taken
 */
export function setUpConversation(actions) {
  const [form, input] = [byId("say"), byId("line")];
  const fit = () => {
    input.style.height = "auto";
    input.style.height = `${Math.min(160, input.scrollHeight + 2)}px`;
  };
  input.addEventListener("input", () => {
    sessionStorage.setItem(draftKey, input.value);
    fit();
  });
  input.addEventListener("keydown", (event) => {
    if (event.key === "Enter" && !event.shiftKey && !event.isComposing) {
      event.preventDefault();
      form.requestSubmit();
    }
  });
  form.addEventListener("submit", async (event) => {
    event.preventDefault();
    const text = input.value.trim();
    if (!text || !(await actions.send(text))) return;
    if (input.value.trim() === text) {
      input.value = "";
      sessionStorage.removeItem(draftKey);
      fit();
    }
  });
}

/** Put a line that came to nothing back into the input, unless something else is being typed there. */
export function giveBack(text) {
  const input = byId("line");
  if (!text || input.value) return;
  input.value = text;
  input.dispatchEvent(new Event("input"));
}

/**
 * Draw what is new; what was drawn stays, so that opened details stay open.
 * @param {object} state
 * @param {object} scene
 * @param {object} actions
 */
export function drawConversation({ session, job, problem }, { effect, canAct, busy, people }, actions) {
  const [log, input] = [byId("log"), byId("line")];
  const { lang } = document.documentElement;
  const asIs = [session.id, lang].join();
  if (asIs !== drawnAs) {
    [drawnAs, drawnTurns] = [asIs, 0];
    log.replaceChildren();
    draftKey = DRAFT + session.id;
    input.value = sessionStorage.getItem(draftKey) ?? "";
  }
  const added = session.turns.slice(drawnTurns);
  if (added.length && !drawnTurns) log.replaceChildren();
  log.append(...added.map((turn) => answered(turn, people, actions)));
  const first = drawnTurns === 0;
  drawnTurns = session.turns.length;
  if (!drawnTurns && !log.childElementCount) {
    log.append(element("div", { class: "empty" }, element("b", {}, say("console.empty_title")), element("p", {}, say("console.empty_text"))));
  }
  fillIfNew(byId("working"), [job, problem?.message, lang], () => [job && working(job, actions), problem && failure(problem, actions)]);
  const asked = session.awaits === "clarification";
  const offered = canAct && !busy ? suggestions(session, effect) : [];
  fillIfNew(byId("chips"), offered, () => offered.map((text) => button(() => actions.send(text), { class: "chip" }, text)));
  byId("say").hidden = !canAct;
  byId("viewer").hidden = canAct;
  byId("send").disabled = busy;
  byId("say").classList.toggle("asked", asked);
  input.placeholder = say(asked ? "console.answer_here" : "console.say_what");
  if (added.length || job || problem) log.scrollTo({ top: log.scrollHeight });
  if (asked && added.length && !first && canAct) input.focus();
}
