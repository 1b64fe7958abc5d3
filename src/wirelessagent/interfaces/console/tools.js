/** Every operation of the server as a form of its own, with what comes of it: what is installed appears by itself. */

import { follow, get, post } from "./api.js";
import { byId, element, table } from "./dom.js";
import { say, trouble } from "./words.js";

const spaced = (name) => name.replaceAll("_", " ");

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
    return { ...inputOf(name, kind, must, help, raw.default) };
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

/** The channels that there are: those of cells on a measured file. */
function channelOf(operation, cells) {
  const measured = cells.filter((cell) => cell.observation);
  const list = element("select", { required: operation.channel === "needed" },
    [...(operation.channel === "needed" ? [] : [element("option", { value: "" }, "")]),
      ...measured.map((cell) => element("option", { value: cell.observation }, cell.name))]);
  const read = () => (list.value ? { observation: list.value } : {});
  const missing = operation.channel === "needed" && !measured.length;
  return { node: missing ? element("p", { class: "note" }, say("console.drop_here")) : element("label", {}, element("span", {}, say("console.channel")), list), read };
}

const shownBlock = (block) =>
  typeof block === "string" ? element("p", {}, block)
    : Array.isArray(block) ? element("p", {}, block.flatMap((line, place) => (place ? [element("br"), line] : [line])))
      : table(block);

/** Set the dialog up; `cells` gives those that there are. */
export function setUpTools(cells) {
  const [list, form, found] = ["tools-list", "tools-form", "tools-found"].map(byId);
  let offered = null;
  const show = () => {
    const operation = offered.operations.find((one) => one.name === list.value);
    const fields = fieldsOf(operation.schema, operation.schema.$defs ?? {});
    const channel = operation.channel === "no" ? null : channelOf(operation, cells());
    const run = element("button", { class: "first" }, say("console.run"));
    found.replaceChildren();
    form.replaceChildren(element("p", { class: "note" }, operation.summary),
      element("div", { class: "fields" }, channel ? [channel.node] : [], fields.nodes), element("div", { class: "buttons" }, run));
    form.onsubmit = async (event) => {
      event.preventDefault();
      run.disabled = true;
      found.replaceChildren(element("div", { class: "skeleton" }));
      try {
        const job = await post(`v1/operations/${encodeURIComponent(operation.name)}`, { ...fields.read(), ...channel?.read() }, true);
        const result = await follow(job.id, (stage) => found.replaceChildren(element("p", { class: "note" }, stage.message)));
        found.replaceChildren(...(result?.blocks ?? []).map(shownBlock));
      } catch (problem) {
        found.replaceChildren(element("p", { class: "problem" }, trouble(problem)));
      } finally {
        run.disabled = false;
      }
    };
  };
  list.addEventListener("change", show);
  byId("tools-open").addEventListener("click", async () => {
    byId("tools").showModal();
    try {
      offered ??= await get("v1/operations");
    } catch (problem) {
      found.replaceChildren(element("p", { class: "problem" }, trouble(problem)));
      return;
    }
    const chosen = list.value || "solve";
    list.replaceChildren(...offered.operations.map((one) => element("option", { value: one.name, selected: one.name === chosen }, one.name)));
    show();
  });
}
