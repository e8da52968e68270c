// The first page: its theme, and buttons that copy. The theme is kept as the documents' own pages keep theirs.

const THEMES = ['auto', 'light', 'dark'];

document.querySelector('#theme').addEventListener('click', () => {
  const next = THEMES[(THEMES.indexOf(document.body.dataset.theme) + 1) % THEMES.length];
  document.body.dataset.theme = next;
  document.querySelector('#theme').title = `Theme: ${next}`;
  try { localStorage.setItem('theme', next); } catch { /* a private window keeps nothing */ }
});

for (const button of document.querySelectorAll('button[data-copy]')) {
  button.addEventListener('click', async () => {
    const before = button.textContent;
    try {
      await navigator.clipboard.writeText(document.querySelector(button.dataset.copy).textContent);
      button.textContent = 'Copied';
    } catch {
      getSelection().selectAllChildren(document.querySelector(button.dataset.copy));
      button.textContent = 'Selected';
    }
    setTimeout(() => { button.textContent = before; }, 1500);
  });
}

addEventListener('keydown', (event) => {
  if (event.key !== '/' || event.target instanceof HTMLTextAreaElement || event.target instanceof HTMLInputElement) return;
  event.preventDefault();
  document.querySelector('input[name=q]').focus();
});
