/** What could be said next: sentences that the agent understands, offered as chips. */

import { isUsable, spentOn } from "./turns.js";
import { human } from "./units.js";
import { say } from "./words.js";

/**
 * @param {{turns: object[], awaits: string}} session
 * @param {object|null} effect the turn in effect
 * @returns {string[]} up to four sentences in the language in use
 */
export function suggestions(session, effect) {
  const last = session.turns.at(-1);
  if (!last) return [say("console.say_save"), say("console.say_rate"), say("console.say_fair")];
  if (session.awaits === "clarification") return [];
  if (last.decision && !isUsable(last)) return [say("console.say_why_not"), say("console.say_undo")];
  const shown = isUsable(last) && last.stage !== "answered" ? last : effect;
  if (!shown) return [say("console.say_save"), say("console.say_rate")];
  const { user_names: names, max_power_w: budget } = shown.decision;
  const spent = names.map((_, user) => spentOn(shown.decision, user));
  const thirsty = spent.indexOf(Math.max(...spent)) + 1;
  return [
    say("console.say_why_power", { number: thirsty }),
    say("console.say_budget", { power: human(Number((budget / 2).toPrecision(2)), "W") }),
    say("console.say_how_sure"),
    ...(effect && session.awaits === "nothing" ? [say("console.say_undo")] : []),
  ];
}
