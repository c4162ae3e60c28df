# Nothing to be done without a window.
