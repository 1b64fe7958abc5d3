"""The data that flows through the chain: one type per file, frozen and validated once."""
