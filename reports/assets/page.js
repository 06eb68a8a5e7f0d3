// What the scripts of a page share: elements, colours of its style, packed numbers; light and dark, print.
const touchdown = (() => {
  "use strict";
  const element = (tag, parent, text = "") => {
    const made = parent.appendChild(document.createElement(tag));
    made.textContent = text;
    return made;
  };

  const button = (parent, text, label, act) => {
    const made = element("button", parent, text);
    made.type = "button";
    if (label) made.setAttribute("aria-label", label);
    made.addEventListener("click", act);
    return made;
  };

  const colours = new Map(); // by the words of the page's style, as long as it stays light or dark
  const probe = element("span", document.body);
  probe.hidden = true;
  const paint = (word) => {
    if (!colours.has(word)) {
      probe.style.color = `var(--${word})`;
      colours.set(word, getComputedStyle(probe).color);
    }
    return colours.get(word);
  };

  const floats = (text, Kind = Float32Array) => {
    const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
    return new Kind(bytes.buffer);
  };

  const readData = (figure) => JSON.parse(figure.querySelector("script").textContent);

  const root = document.documentElement;
  const theme = document.getElementById("theme");
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  let night = dark.matches;
  const light = () => {
    root.style.colorScheme = night ? "dark" : "light";
    theme.setAttribute("aria-pressed", String(night));
    colours.clear();
    window.dispatchEvent(new Event("repaint"));
  };
  theme.hidden = false;
  theme.addEventListener("click", () => { night = !night; light(); });
  dark.addEventListener("change", () => { night = dark.matches; light(); });
  theme.setAttribute("aria-pressed", String(night));

  const folded = [];
  window.addEventListener("beforeprint", () => {
    root.style.colorScheme = "light";
    document.querySelectorAll("details:not([open])").forEach((d) => { d.open = true; folded.push(d); });
  });
  window.addEventListener("afterprint", () => {
    folded.splice(0).forEach((d) => { d.open = false; });
    light();
  });

  return { element, button, paint, floats, readData };
})();
