"""The live preview: a page on this machine that shows a material while its files change."""
