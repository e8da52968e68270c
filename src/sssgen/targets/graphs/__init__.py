"""The graphs of nodes that an engine pastes or imports: records that a template lays out."""
