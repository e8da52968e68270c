"use strict";
{
  const tip = document.getElementById("tip");
  const heads = [...document.querySelectorAll("thead th")];
  const body = document.querySelector("tbody");
  const rows = [...body.rows];
  const names = heads.map((head) => head.textContent);
  const title = names.indexOf("technique");

  const show = (dot) => {
    const row = document.getElementById("row" + dot.dataset.row);
    const name = document.createElement("b");
    name.textContent = row.cells[title].textContent;
    const table = document.createElement("table");
    names.forEach((name, at) => {
      const text = row.cells[at].textContent;
      if (at === title || text === "" || text === "–") return;
      const line = table.insertRow();
      line.insertCell().textContent = name;
      line.insertCell().textContent = text;
    });
    tip.replaceChildren(name, table);
    tip.hidden = false;
    const place = dot.querySelector(".near").getBoundingClientRect();
    const x = place.right + 8 + tip.offsetWidth > innerWidth ? place.left - 8 - tip.offsetWidth : place.right + 8;
    const y = Math.min(place.top, innerHeight - tip.offsetHeight - 8);
    tip.style.left = Math.max(4, x) + "px";
    tip.style.top = Math.max(4, y) + "px";
  };
  const hide = () => { tip.hidden = true; };

  const goTo = (dot) => {
    const row = document.getElementById("row" + dot.dataset.row);
    body.querySelector(".chosen")?.classList.remove("chosen");
    row.classList.add("chosen");
    row.hidden = false;
    hide();
    row.scrollIntoView({ block: "center" });
  };

  for (const panel of document.querySelectorAll(".panel")) {
    const dots = [...panel.querySelectorAll(".dot")].sort((one, other) => one.dataset.row - other.dataset.row);
    for (const dot of dots) {
      dot.addEventListener("mouseenter", () => show(dot));
      dot.addEventListener("mouseleave", hide);
      dot.addEventListener("focus", () => show(dot));
      dot.addEventListener("blur", hide);
      dot.addEventListener("click", () => goTo(dot));
    }
    panel.addEventListener("keydown", (event) => {
      const at = dots.indexOf(document.activeElement);
      const to = { ArrowRight: at + 1, ArrowDown: at + 1, ArrowLeft: Math.max(at - 1, 0), ArrowUp: Math.max(at - 1, 0),
        Home: 0, End: dots.length - 1 }[event.key];
      if (to !== undefined) dots[Math.min(to, dots.length - 1)]?.focus();
      else if (event.key === "Enter" && at >= 0) goTo(dots[at]);
      else if (event.key === "Escape") { hide(); panel.focus(); }
      else return;
      event.preventDefault();
    });
  }

  const key = (row, at) => {
    const cell = row.cells[at];
    return cell.dataset.key === undefined ? cell.textContent : Number(cell.dataset.key);
  };
  const order = (one, other) => {
    const numbers = [typeof one === "number", typeof other === "number"];
    if (numbers[0] && numbers[1]) return one - other;
    return numbers[0] !== numbers[1] ? numbers[1] - numbers[0] : one.localeCompare(other);
  };
  heads.forEach((head, at) => head.firstChild.addEventListener("click", () => {
    const down = head.getAttribute("aria-sort") === "ascending";
    heads.forEach((other) => other.removeAttribute("aria-sort"));
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    rows.sort((one, other) => (down ? -1 : 1) * order(key(one, at), key(other, at)));
    body.append(...rows);
  }));

  const form = document.querySelector("form");
  const filter = () => {
    const { scene, role, text, front } = form.elements;
    const wanted = text.value.trim().toLowerCase();
    for (const row of rows) {
      row.hidden = (scene.value !== "" && row.dataset.scene !== scene.value)
        || (role.value !== "" && row.dataset.role !== role.value)
        || (front.checked && row.dataset.front !== "1")
        || !row.cells[title].textContent.toLowerCase().includes(wanted);
    }
    const shown = rows.filter((row) => !row.hidden).length;
    form.querySelector("output").textContent = `${shown} of ${rows.length} rows`;
  };
  form.addEventListener("input", filter);
  form.addEventListener("submit", (event) => event.preventDefault());
  filter();
}
