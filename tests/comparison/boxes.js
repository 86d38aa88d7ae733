// every visible text of the page that overlaps another one or reaches beyond the window, by its box
() => {
  const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT), texts = [];
  const clipped = (node, rect) => {  // what a scrolling box does not show is not there
    let { left, right, top, bottom } = rect;
    for (let parent = node.parentElement; parent; parent = parent.parentElement) {
      if (!["auto", "scroll", "hidden"].includes(getComputedStyle(parent).overflowX)) continue;
      const box = parent.getBoundingClientRect();
      [left, right] = [Math.max(left, box.left), Math.min(right, box.right)];
    }
    return { left, right, top, bottom };
  };
  for (let node = walker.nextNode(); node; node = walker.nextNode()) {
    const holder = node.parentElement;
    if (!node.data.trim() || ["SCRIPT", "STYLE", "TITLE", "OPTION", "TEXTAREA"].includes(holder.tagName.toUpperCase())) continue;
    if (!holder.checkVisibility({ checkVisibilityCSS: true })) continue;
    const range = document.createRange();
    range.selectNodeContents(node);
    for (const rect of range.getClientRects()) {
      const box = clipped(node, rect);
      if (box.right - box.left > 1 && box.bottom - box.top > 1) texts.push({ ...box, text: node.data.trim().slice(0, 30) });
    }
  }
  texts.sort((a, b) => a.top - b.top);
  const faults = texts.filter(box => box.right > innerWidth + 1 || box.left < -1).map(box => `beyond the window: ${box.text}`);
  texts.forEach((a, i) => {
    for (let j = i + 1; j < texts.length && texts[j].top < a.bottom; j++) {
      const b = texts[j], wide = Math.min(a.right, b.right) - Math.max(a.left, b.left), tall = Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
      if (wide > 2 && tall > 0.35 * Math.min(a.bottom - a.top, b.bottom - b.top)) faults.push(`${a.text} | ${b.text}`);
    }
  });
  return { count: texts.length, faults: faults.slice(0, 10) };
}
