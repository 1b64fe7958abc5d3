/** The decisions in time: each can be opened, two can be compared. */

import { button, byId, element, fill } from "./dom.js";
import { planOf, saidFor, worthOf } from "./turns.js";
import { clock } from "./units.js";
import { say, stageName } from "./words.js";

const marked = new Set();

/** The turns that decided something; a plan that was applied as it was is told once. */
function decisionsOf(session) {
  const told = new Set(session.turns.map((turn) => planOf(session, turn)));
  return session.turns.filter((turn) => turn.decision && !told.has(turn));
}

function stateOf(turn, { effect, planTurn }) {
  if (turn === effect) return ["effect", say("console.in_effect")];
  if (turn === planTurn) return ["waits", say("console.waits")];
  return turn.stage === "answered" ? ["supposed", say("console.what_if")] : [turn.stage, stageName(turn.stage)];
}

function entry(session, turn, scene, actions, redraw) {
  const [kind, text] = stateOf(turn, scene);
  const name = say("turn.column", { number: turn.number });
  return element("li", { class: `entry ${kind}` },
    button(() => actions.look(turn.number), { class: "open", "aria-current": scene.shown === turn && "true" },
      element("span", { class: "when" }, `${turn.number} · ${clock(turn.at_utc)}`, scene.people && turn.by ? ` · ${turn.by}` : ""),
      element("span", { class: "asked-for", title: saidFor(session, turn) }, saidFor(session, turn)),
      element("b", {}, worthOf(turn)), element("span", { class: `badge ${kind}` }, text)),
    element("label", { class: "pick" }, element("input", {
      type: "checkbox", "aria-label": say("console.pick", { turn: name }), checked: marked.has(turn.number),
      change: (event) => {
        if (event.target.checked) marked.add(turn.number);
        else marked.delete(turn.number);
        redraw();
      },
    }), say("console.compare_one")));
}

/** Draw the card. */
export function drawTimeline(session, scene, actions) {
  const turns = decisionsOf(session);
  const whatIfs = turns.filter((turn) => turn.stage === "answered");
  const redraw = () => drawButtons(session, whatIfs, scene, actions);
  for (const number of marked) if (!turns.some((turn) => turn.number === number)) marked.delete(number);
  const list = byId("timeline");
  const atEnd = list.scrollLeft + list.clientWidth >= list.scrollWidth - 8;
  list.replaceChildren(...turns.map((turn) => entry(session, turn, scene, actions, redraw)));
  byId("timeline-empty").hidden = turns.length > 0;
  list.hidden = turns.length === 0;
  if (atEnd) list.scrollLeft = list.scrollWidth;
  redraw();
}

function drawButtons(session, whatIfs, { effect }, actions) {
  const chosen = decisionsOf(session).filter((turn) => marked.has(turn.number));
  const small = (text, turns) => button(() => actions.compare(turns), { class: "small", disabled: turns.length < 2 && turns === chosen }, text);
  fill(byId("timeline-buttons"),
    chosen.length > 0 && small(say("console.compare", { count: chosen.length }), chosen),
    whatIfs.length > 0 && small(say("console.what_ifs", { count: whatIfs.length }), [...(effect ? [effect] : []), ...whatIfs.slice(-3)]));
}
