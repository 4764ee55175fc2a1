//! What a glTF scene needs: its materials, read without geometry and without trust.
