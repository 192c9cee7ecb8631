# The editor in a container: docker compose up, then http://localhost:8080 (compose.yaml). Projects are in a volume.
FROM python:3.12-slim AS wheel
WORKDIR /source
COPY . .
RUN pip wheel --no-cache-dir --no-deps --wheel-dir /wheels .

FROM python:3.12-slim
# hadolint ignore=DL3008  # security updates of the system come with every build
RUN apt-get update \
    && apt-get install -y --no-install-recommends libegl1 libgl1 libgomp1 libusb-1.0-0 libx11-6 \
    && rm -rf /var/lib/apt/lists/*
COPY --from=wheel /wheels /wheels
COPY constraints.txt constraints-light.txt /etc/diorama/
# The build of torch without CUDA, and Open3D without its notebook parts: together they would be several GB more.
RUN pip install --no-cache-dir 'uv>=0.9' \
    && uv pip install --system --no-cache --torch-backend cpu --constraints /etc/diorama/constraints.txt \
        --overrides /etc/diorama/constraints-light.txt "$(ls /wheels/*.whl)[agents]" open3d-cpu==0.20.0 \
    && pip uninstall --yes uv \
    && rm -r /wheels \
    && useradd --create-home --uid 1000 diorama \
    && install --directory --owner diorama /projects /home/diorama/.cache/diorama
USER 1000
VOLUME ["/projects", "/home/diorama/.cache/diorama"]
EXPOSE 8080
HEALTHCHECK --interval=30s --timeout=5s --start-period=180s CMD ["python", "-c", "import os, urllib.request as u; \
u.urlopen('http://127.0.0.1:8080/?token=' + os.environ.get('DIORAMA_TOKEN', ''), timeout=4)"]
# Whoever comes from outside the container must bring a token: DIORAMA_TOKEN, or the one that is printed.
CMD ["sh", "-c", "exec python -m diorama_app --host 0.0.0.0 --port 8080 --no-open --projects /projects \
${DIORAMA_TOKEN:+--token \"$DIORAMA_TOKEN\"}"]
