// Sphinx has no summary of a place without text, such as an entry of the index, and then fails: here it is the page's.
/* global Search */
if (typeof Search !== 'undefined') {
  const summary = Search.makeSearchSummary;
  Search.makeSearchSummary = (text, words, anchor) => summary(text, words, anchor) ?? summary(text, words, '') ?? document.createElement('p');
}
