"""What buttons, hotkeys and the palette do, one module a command group."""
