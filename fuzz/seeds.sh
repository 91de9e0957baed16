#!/bin/sh
# Copies the examples and the inputs of the tests into the corpus of the target `text`; they are not kept twice.
set -eu
cd "$(dirname "$0")"
mkdir -p corpus/text
find ../examples ../tests -name '*.mech' | while read -r file; do
    cp "$file" "corpus/text/$(echo "${file#../}" | tr '/' '_')"
done
