/** What the console knows, in one place, and what follows from it. */

import { isUsable, turnOf } from "./turns.js";

/**
 * `looking` is the number of the turn that is looked at, null for now; `job` what is under way, with its stages;
 * `problem` what went wrong last, until it is dismissed.
 */
export const state = {
  console: null, cell: null, session: null, channel: null,
  looking: null, job: null, problem: null, connected: true,
};

/** What follows from the state: which turns count, what is looked at, and what may be done. */
export function scene() {
  const { session, looking } = state;
  const effect = turnOf(session, session.in_effect);
  const planTurn = session.plan ? turnOf(session, session.plan.turn) : null;
  const looked = looking === null ? null : turnOf(session, looking);
  const last = session.turns.findLast((turn) => isUsable(turn)) ?? null;
  const failed = session.turns.at(-1)?.stage === "nothing" && session.turns.at(-1).decision ? session.turns.at(-1) : null;
  const shown = looked ?? planTurn ?? failed ?? effect ?? last;
  return {
    plan: session.plan, planTurn, effect, shown, looked,
    canAct: state.console.role === "operator", busy: Boolean(state.job), people: state.console.signed_in,
    stale: Boolean(session.plan) && Date.parse(session.plan.until_utc) < Date.now(),
  };
}
