// Names for what the theme leaves without one, so that a screen reader can tell them apart, and wide tables that keys can
// scroll.
const names = () => {
  document.querySelector(".md-search")?.setAttribute("aria-label", "Search");
  for (const wide of document.querySelectorAll(".md-typeset__scrollwrap")) wide.tabIndex = 0;
  const seen = new Map();
  for (const nav of document.querySelectorAll("nav")) {
    const label = document.getElementById(nav.getAttribute("aria-labelledby"))?.textContent;
    const name = (nav.getAttribute("aria-label") ?? label ?? (nav.className === "md-code__nav" ? "Code" : "Pages")).trim();
    const count = seen.get(name) ?? 0;
    seen.set(name, count + 1);
    if (count === 0 && nav.hasAttribute("aria-label")) continue;
    nav.removeAttribute("aria-labelledby");
    nav.setAttribute("aria-label", count ? `${name} ${count + 1}` : name);
  }
};
names();
// The theme adds its buttons a little later.
new MutationObserver((changes, self) => {
  self.disconnect();
  names();
  self.observe(document.body, {childList: true, subtree: true});
}).observe(document.body, {childList: true, subtree: true});
