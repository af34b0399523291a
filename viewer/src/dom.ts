// SPDX-FileCopyrightText: Sand Reckoner contributors
// SPDX-License-Identifier: BSD-3-Clause

export type Child = Node | string | null | undefined | false;

/** An element with its attributes, handlers (on...) and children. */
export function h<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Record<string, unknown> = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name.startsWith("on")) {
      element.addEventListener(name.slice(2), value as EventListener);
    } else {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  append(element, children);
  return element;
}

export function append(parent: Node, children: Child[]): void {
  for (const child of children) if (child) parent.appendChild(typeof child === "string" ? document.createTextNode(child) : child);
}

export function replace(parent: Element, ...children: Child[]): void {
  parent.replaceChildren();
  append(parent, children);
}

export interface Choice {
  value: string;
  label: string;
  group?: string | undefined;
}

/** A labelled <select>; `chosen` is called with the new value. */
export function chooser(
  label: string,
  choices: readonly Choice[],
  value: string,
  chosen: (value: string) => void,
): HTMLLabelElement {
  const select = h("select", { onchange: () => chosen(select.value) });
  fillChoices(select, choices, value);
  return h("label", { class: "field" }, h("span", {}, label), select);
}

export function fillChoices(select: HTMLSelectElement, choices: readonly Choice[], value: string): void {
  select.replaceChildren();
  const groups = new Map<string, HTMLOptGroupElement>();
  for (const choice of choices) {
    const option = h("option", { value: choice.value, selected: choice.value === value }, choice.label);
    if (!choice.group) {
      select.appendChild(option);
      continue;
    }
    let group = groups.get(choice.group);
    if (!group) {
      group = h("optgroup", { label: choice.group });
      groups.set(choice.group, group);
      select.appendChild(group);
    }
    group.appendChild(option);
  }
}

/** Offers a text as a file to save. */
export function download(name: string, text: string): void {
  const url = URL.createObjectURL(new Blob([text], { type: "text/csv" }));
  const link = h("a", { href: url, download: name });
  document.body.appendChild(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
