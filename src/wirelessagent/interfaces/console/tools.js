/** Every operation of the server as a form of its own, with what comes of it: what is installed appears by itself. */

import { get, path, remove, upload, worked } from "./api.js";
import { byId, element, table } from "./dom.js";
import { choices, onSend, refuse } from "./forms.js";
import { say } from "./words.js";

const SENSED = "sensed";

const UNITS = { w_per_hz: "W/Hz", bps_per_hz: "bit/s/Hz", bps: "bit/s", hz: "Hz", db: "dB", w: "W", s: "s", m: "m" };

/** A field's name for people, the unit that it ends in set apart: "max_power_w" is "max power, W". */
function spaced(name) {
  const unit = Object.keys(UNITS).find((end) => name.endsWith(`_${end}`));
  const text = unit ? name.slice(0, -unit.length - 1) : name;
  return text.replaceAll("_", " ") + (unit ? `, ${UNITS[unit]}` : "");
}

/** What may stand in a field, through references and "or null". */
function kindOf(schema, definitions) {
  if (schema.$ref) return kindOf(definitions[schema.$ref.split("/").pop()], definitions);
  const options = schema.anyOf?.filter((one) => one.type !== "null");
  return options ? { ...kindOf(options[0], definitions), title: schema.title } : schema;
}

/**
 * The fields of a schema, and what was entered: only what was, so that the server's defaults hold.
 * @returns {{nodes: Node[], read: () => object}}
 */
function fieldsOf(schema, definitions) {
  const parts = Object.entries(schema.properties ?? {}).map(([name, raw]) => {
    const kind = kindOf(raw, definitions);
    const must = (schema.required ?? []).includes(name);
    const help = raw.description ?? "";
    if (kind.properties) {
      const inner = fieldsOf(kind, definitions);
      const node = element("details", { class: "more" }, element("summary", {}, spaced(name)),
        element("div", { class: "fields" }, inner.nodes));
      const read = () => (Object.keys(inner.read()).length ? { [name]: inner.read() } : {});
      return { node, read };
    }
    return inputOf(name, kind, must, help, raw.default);
  });
  return { nodes: parts.map((part) => part.node), read: () => Object.assign({}, ...parts.map((part) => part.read())) };
}

function inputOf(name, kind, must, help, preset) {
  const number = kind.type === "number" || kind.type === "integer";
  const shown = preset === null || preset === undefined ? "" : String(preset);
  const input = kind.enum
    ? element("select", {}, [...(must ? [] : [""]), ...kind.enum].map((one) => element("option", { value: one, selected: one === preset }, String(one))))
    : kind.type === "boolean"
      ? element("input", { type: "checkbox", checked: preset === true })
      : element("input", { type: number ? "number" : "text", step: kind.type === "integer" ? "1" : "any", required: must, placeholder: shown });
  const read = () => {
    if (kind.type === "boolean") return input.checked === (preset === true) ? {} : { [name]: input.checked };
    if (input.value === "" || (kind.enum && input.value === preset)) return {};
    if (kind.type === "array") return { [name]: input.value.split(",").map((part) => part.trim()).filter(Boolean) };
    return { [name]: number ? Number(input.value) : input.value };
  };
  return { node: element("label", { title: help }, element("span", {}, spaced(name)), input), read };
}

/**
 * The channels that there are: what the cell that is looked at has sensed, and the measured files of all cells.
 * @param {{channel: string}} operation
 * @param {{cell: object, channel: object|null, cells: object[]}} there
 */
function channelOf({ channel: need }, { cell, channel, cells }) {
  const list = element("select", { required: need === "needed" });
  choices(list, [...(need === "needed" ? [] : [["", ""]]), ...(channel ? [[SENSED, say("console.as_sensed", { name: cell.name })]] : []),
    ...cells.filter((one) => one.observation).map((one) => [one.observation, one.name])]);
  return {
    node: list.options.length ? element("label", { class: "broad" }, element("span", {}, say("console.channel")), list) : element("p", { class: "note" }, say("console.drop_here")),
    read: () => list.value,
  };
}

/** Do something with the id of a channel; what was sensed is sent as a file for as long as that takes. */
async function withChannel(chosen, channel, act) {
  if (chosen !== SENSED) return act(chosen ? { observation: chosen } : {});
  const file = JSON.stringify({ gain: channel.observed_gain, user_names: channel.user_names });
  const { id } = await upload("v1/observations?name=sensed.json", file);
  return act({ observation: id }).finally(() => remove(`v1/observations/${id}`));
}

const shownBlock = (block) =>
  typeof block === "string" ? element("p", {}, block)
    : Array.isArray(block) ? element("p", {}, block.flatMap((line, place) => (place ? [element("br"), line] : [line])))
      : table(block);

const drawn = (svg, name) => element("img", { class: "drawn", src: `data:image/svg+xml,${encodeURIComponent(svg)}`, alt: name });

/** Set the dialog up; `there` gives the cells, and the one that is looked at with its channel. */
export function setUpTools(there) {
  const [list, form, found] = ["tools-list", "tools-form", "tools-found"].map(byId);
  let offered = null;
  const show = () => {
    const operation = offered.find((one) => one.name === list.value);
    const fields = fieldsOf(operation.schema, operation.schema.$defs ?? {});
    const channel = operation.channel === "no" ? null : channelOf(operation, there());
    found.replaceChildren();
    refuse(form, null);
    byId("tools-summary").textContent = operation.summary;
    byId("tools-fields").replaceChildren(...(channel ? [channel.node] : []), ...fields.nodes);
    onSend(form, async () => {
      found.replaceChildren(element("div", { class: "skeleton" }));
      const told = (stage) => found.replaceChildren(element("p", { class: "note" }, stage.message));
      try {
        const result = await withChannel(channel?.read() ?? "", there().channel, (on) =>
          worked(path`v1/operations/${operation.name}`, { ...fields.read(), ...on, picture: true }, told));
        found.replaceChildren(...(result?.blocks ?? []).map(shownBlock), ...(result?.picture ? [drawn(result.picture, operation.summary)] : []));
      } catch (problem) {
        found.replaceChildren();
        throw problem;
      }
    });
  };
  list.addEventListener("change", show);
  byId("tools-open").addEventListener("click", async () => {
    byId("tools").showModal();
    try {
      offered ??= (await get("v1/operations")).operations;
      choices(list, offered.map(({ name }) => [name, name]), list.value || "solve");
      show();
    } catch (problem) {
      refuse(form, problem);
    }
  });
}
