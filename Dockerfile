# The same scripts as on a bare machine. Build: docker build -t groundloop .
# Run, with the run folders kept outside:
#   docker run --rm -v "$PWD/runs:/groundloop/runs" groundloop run scenarios/lab_p3dx.yaml
FROM debian:bookworm
WORKDIR /groundloop
COPY ci ci
RUN ci/setup && rm -rf /var/lib/apt/lists/*
COPY . .
RUN ci/build release
ENTRYPOINT ["build/release/groundloop"]
CMD ["--help"]
