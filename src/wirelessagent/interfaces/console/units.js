/** Figures as people read them: three significant digits, an SI prefix, always a unit; as the agent writes them. */

import { language } from "./words.js";

const PREFIXES = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""], [1e-3, "m"], [1e-6, "µ"], [1e-9, "n"]];

/** Three significant digits, without an exponent. */
export const digits = (value, count = 3) => String(Number(Number(value).toPrecision(count))).replace("-", "−");

/**
 * A figure with its unit: human(15606, "W") is "15.6 kW".
 * @param {number|null} value
 * @param {string} unit
 */
export function human(value, unit) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return `0 ${unit}`.trim();
  const size = Math.abs(value);
  if (!unit || unit.endsWith("/Hz") || size >= 1e15) return `${digits(value)} ${unit}`.trim();
  const [scale, prefix] = PREFIXES.find(([least]) => size >= least * 0.9995) ?? PREFIXES.at(-1);
  return `${digits(value / scale)} ${prefix}${unit}`;
}

export const watts = (value) => human(value, "W");
export const rate = (value) => human(value, "bit/s");

/** A figure with its sign, for what is more or less. */
export const signed = (value, unit) => (value > 0 ? "+" : "") + human(value, unit);

/** A share in percent. */
export function percent(share) {
  if (Math.abs(share) <= 1e-9) return "0 %";
  if (Math.abs(share) < 1e-5) return "< 0.001 %";
  return `${digits(100 * share, 2)} %`;
}

/** A gain in dB; minus infinity for none. */
export const decibel = (gain) => 10 * Math.log10(gain);

/** A level in dB as it is written, without its unit. */
export const level = (db) => db.toFixed(1).replace("-", "−");

/** What to divide figures up to `largest` by for an axis, and the unit with its prefix. */
export function prefixed(largest, unit) {
  const [scale, prefix] = PREFIXES.find(([least]) => largest >= least) ?? [1, ""];
  return { scale, unit: prefix + unit };
}

/** An ISO time as the time of day in the reader's zone, with its day where that is not today. */
export function clock(isoTime) {
  const time = new Date(isoTime);
  const day = time.toDateString() === new Date().toDateString() ? {} : { day: "numeric", month: "short" };
  return time.toLocaleString(language(), { ...day, hour: "2-digit", minute: "2-digit", hourCycle: "h23" });
}
