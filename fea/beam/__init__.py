"""A pin as a Timoshenko beam of stepped sections, with notch factors and its own error."""
