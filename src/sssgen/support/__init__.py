"""What every other package uses: errors with places, files, caches, and input formats with places."""
