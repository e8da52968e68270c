"""The graphs of nodes that an engine pastes or imports: records, which a template lays out as the engine writes them."""
