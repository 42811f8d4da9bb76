// What the page does by itself: takes dropped files, lets points be dragged, keeps the focus, and
// says when the server is gone.
(() => {
  // Files ------------------------------------------------------------------------------------
  async function take(file) {
    const most = Number(document.querySelector(".drop").dataset.most);
    if (file.size > most) {
      const size = (file.size / 1e9).toFixed(2);
      emitEvent("dropped", {
        refused: `${file.name} has ${size} GB, and the studio takes files of at most ` +
          `${(most / 1e9).toFixed(2)} GB; identify from it on the command line, hyst identify ` +
          "--in-file yes, or cut out a part",
      });
      return;
    }
    try {
      const answer = await fetch("/upload", {
        method: "PUT", body: file, headers: { "x-file-name": encodeURIComponent(file.name) },
      });
      emitEvent("dropped", await answer.json());
    } catch {
      emitEvent("dropped", { refused: `${file.name} could not be sent; choose it again` });
    }
  }
  const zone = (event) => event.target.closest?.(".drop");
  document.addEventListener("change", (event) => {
    if (event.target.id === "dropped" && event.target.files.length) take(event.target.files[0]);
  });
  for (const kind of ["dragover", "drop"]) {
    document.addEventListener(kind, (event) => {
      event.preventDefault();
      zone(event)?.classList.toggle("over", kind === "dragover");
      if (kind === "drop" && event.dataTransfer.files.length) take(event.dataTransfer.files[0]);
    });
  }

  // Points -----------------------------------------------------------------------------------
  let held = null;
  let sent = 0;
  function move(point, value) {
    const circle = document.getElementById(`point-${point}`);
    circle?.closest(".editor").dispatchEvent(
      new CustomEvent("moved", { detail: { point, value } }));
  }
  function valueAt(event, circle) {
    const svg = circle.ownerSVGElement;
    const { low, high, begin, end } = circle.parentNode.dataset;
    const y = new DOMPoint(event.clientX, event.clientY).matrixTransform(
      svg.getScreenCTM().inverse()).y;
    return Number(low) + (Number(high) - Number(low)) * (y - begin) / (end - begin);
  }
  document.addEventListener("pointerdown", (event) => {
    const circle = event.target.closest?.(".point");
    if (!circle) return;
    held = circle.dataset.point;
    circle.focus();
    event.preventDefault();
  });
  document.addEventListener("pointermove", (event) => {
    if (held === null || performance.now() - sent < 40) return;
    sent = performance.now();
    const circle = document.getElementById(`point-${held}`);
    if (circle) move(Number(held), valueAt(event, circle));
  });
  document.addEventListener("pointerup", (event) => {
    if (held === null) return;
    const circle = document.getElementById(`point-${held}`);
    if (circle) move(Number(held), valueAt(event, circle));
    held = null;
  });
  document.addEventListener("pointercancel", () => { held = null; });
  const KEYS = { ArrowUp: 1, ArrowRight: 1, ArrowDown: -1, ArrowLeft: -1, PageUp: 5, PageDown: -5 };
  document.addEventListener("keydown", (event) => {
    const circle = event.target.closest?.(".point");
    if (!circle || !(event.key in KEYS)) return;
    event.preventDefault();
    const { point, value, step } = circle.dataset;
    move(Number(point), Number(value) + KEYS[event.key] * Number(step));
  });

  // Focus: what is drawn again gets it back ----------------------------------------------------
  let last = null;
  document.addEventListener("focusin", (event) => {
    last = event.target.closest?.("[id]")?.id ?? null;
  });
  document.addEventListener("pointerdown", () => { last = null; }, true);
  new MutationObserver(() => {
    if (last === null || (document.activeElement && document.activeElement !== document.body)) return;
    const element = document.getElementById(last);
    const inner = element?.matches("input, button, [tabindex]") ? element
      : element?.querySelector("input, button, [tabindex='0']");
    inner?.focus({ preventScroll: true });
  }).observe(document.documentElement, { childList: true, subtree: true });

  // The server ---------------------------------------------------------------------------------
  const watch = setInterval(() => {
    if (!window.socket) return;
    clearInterval(watch);
    const lost = () => document.getElementById("lost");
    window.socket.on("disconnect", () => {
      const folder = document.getElementById("head").dataset.folder;
      lost().textContent = "The studio does not answer: it was stopped, or is starting again. " +
        `What you saved is in ${folder}. To go on, run hyst studio there and open the address ` +
        "that it prints; this page tries to connect by itself.";
      lost().hidden = false;
    });
    window.socket.on("connect", () => { lost().hidden = true; });
  }, 100);
})();
