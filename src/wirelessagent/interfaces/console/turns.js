/** What turns hold, read in one place: who is promised what, limits by user, and what two allocations differ in. */

import { aimName, heading, say, userName } from "./words.js";
import { human, percent, rate, watts } from "./units.js";

/** What stands where a limit is not asked for. */
export const NONE = "–";

/** Whether a turn holds an allocation that could be used. */
export const isUsable = (turn) => Boolean(turn?.decision && ["optimal", "feasible"].includes(turn.decision.status));

/** The turn of a session with this number, or null. */
export const turnOf = (session, number) => session?.turns.find((turn) => turn.number === number) ?? null;

/** Each user's rate as it is expected, with its 90 % band where one is known, and its promise; all in bit/s. */
export function ratesOf(turn) {
  const { decision, report } = turn;
  const forecast = report?.forecast ?? null;
  const sure = decision.outage_probability !== null && decision.outage_probability !== undefined;
  return decision.rate_bps.map((planned, user) => ({
    mean: forecast?.mean_bps?.[user] ?? decision.expected_rate_bps?.[user] ?? planned,
    low: forecast?.low_bps?.[user] ?? null,
    high: forecast?.high_bps?.[user] ?? null,
    promised: sure ? planned : asked(turn, user),
  }));
}

/** The limits that a turn's decision was made for: of a what-if those that it supposed. */
const limitsOf = (turn) => (turn?.supposed ?? turn?.request)?.constraints;

function asked(turn, user) {
  const limits = byUser(limitsOf(turn)?.min_rate_bps);
  const name = turn.decision.user_names[user];
  return limits[name] ?? limits[String(user + 1)] ?? limits.all ?? null;
}

function byUser(limit) {
  if (limit === null || limit === undefined) return {};
  return typeof limit === "object" && !Array.isArray(limit) ? limit : { all: limit };
}

function who(user, several) {
  if (user === "all") return say(several ? "whom.everybody_else" : "whom.everybody");
  return /^\d+$/.test(user) ? say("whom.user", { number: user }) : userName(user);
}

function limitText(kind, value) {
  if (value === undefined || value === null) return NONE;
  if (kind === "outage_probability") return percent(1 - value);
  if (kind.endsWith("_bps")) return rate(value);
  if (kind.endsWith("_w")) return watts(value);
  if (kind === "users" || kind === "leave_out") return [value].flat().map((user) => who(String(user))).join(", ");
  return Array.isArray(value) ? value.join(", ") : typeof value === "object" ? JSON.stringify(value) : String(value);
}

const LIMITS = {
  min_rate_bps: "console.limit_min_rate", max_rate_bps: "console.limit_max_rate", max_power_w: "console.limit_power",
  outage_probability: "console.limit_kept", subcarrier_max_power_w: "limit.subcarrier_max_power_w",
  forbidden: "limit.forbidden", users: "dropped.users", leave_out: "dropped.leave_out", weights: "limit.weights",
  resource_block_group_size: "limit.resource_block_group_size",
};

/** What a turn asks for, with the probability that was assumed where none was named. */
function asksOf(turn) {
  const assumed = turn?.decision?.outage_probability;
  return { ...(assumed ? { outage_probability: assumed } : {}), ...limitsOf(turn) };
}

/**
 * What turns ask for, a row for each limit of each user with its text for each turn.
 * @returns {Array<{label: string, texts: string[]}>}
 */
export function limitRows(turns) {
  const asks = turns.map(asksOf);
  const kinds = new Set(asks.flatMap((one) => Object.keys(one)));
  return [...kinds].flatMap((kind) => {
    const limits = asks.map((one) => byUser(one[kind]));
    const users = [...new Set(limits.flatMap((one) => Object.keys(one)))];
    return users.map((user) => {
      const label = kind in LIMITS ? say(LIMITS[kind]) : kind.replaceAll("_", " ");
      const whom = kind.endsWith("_rate_bps") || user !== "all" ? who(user, users.length > 1) : "";
      return {
        label: heading(whom ? say("console.label_of", { label, who: whom }) : label),
        texts: limits.map((one) => limitText(kind, one[user] ?? one.all)),
      };
    });
  });
}

/** The rates of those whom a turn's request serves, in bit/s. */
export function servedRates(turn) {
  const { users, leave_out: left } = limitsOf(turn) ?? {};
  const among = (list, user) => [list].flat().some((one) => [String(user + 1), turn.decision.user_names[user]].includes(String(one)));
  return turn.decision.rate_bps.filter((_, user) => (!users || among(users, user)) && !(left && among(left, user)));
}

/** The subcarriers, from 0, that a decision gives to a user. */
export const ownedBy = ({ owner }, user) => owner.flatMap((who, place) => (who === user ? [place] : []));

/** The power that a decision spends on a user, in W. */
export const spentOn = (decision, user) => sum(ownedBy(decision, user).map((place) => decision.power_w[place]));

/** The subcarriers, from 0, that two decisions give to different users. */
export function changedHands(before, after) {
  if (!before || !after || before.owner.length !== after.owner.length) return [];
  return after.owner.flatMap((owner, place) => (owner === before.owner[place] ? [] : [place]));
}

export const sum = (values) => values.reduce((total, value) => total + value, 0);

/** Whether two decisions are the same allocation. */
const sameAllocation = (one, other) => JSON.stringify([one.owner, one.power_w]) === JSON.stringify([other.owner, other.power_w]);

/** The plan that a turn applied as it was, or null: "yes" says less than the line that planned it. */
export function planOf(session, turn) {
  if (turn.stage !== "applied" || !turn.decision) return null;
  return session.turns.findLast((one) => one.number < turn.number && one.stage === "planned" && one.decision
    && sameAllocation(one.decision, turn.decision)) ?? null;
}

/** What was said for a turn's decision. */
export const saidFor = (session, turn) => (planOf(session, turn) ?? turn).text;

/** What a turn's decision is worth, with the power that it takes. */
export function worthOf({ decision }) {
  const value = isUsable({ decision }) ? human(decision.value, decision.unit) : say(`status.${decision.status}`);
  return decision.unit === "W" || !isUsable({ decision }) ? value : `${value} · ${watts(decision.total_power_w)}`;
}

/** A turn in one short line: its aim and what it is worth. */
export function inShort(turn) {
  const { objective, value, unit } = turn.decision;
  return `${heading(aimName(objective))} · ${isUsable(turn) ? human(value, unit) : say(`status.${turn.decision.status}`)}`;
}
