// Names files at the drop, announces them to the server as keys of `mime_type`, and sends them.
// By itself the widget plays more than 1 s, sends two files, plays again, and sends the next two.
FilePond.setOptions({
    allowImagePreview: false,
    allowMinimumUploadDuration: false,
    instantUpload: false,
    maxParallelUploads: 1000,
})
const {IDLE, INIT, LOADING, LOAD_ERROR} = FilePond.FileStatus
const holds = part => part.shadowRoot?.querySelector('.filepond--root')
const area_of = event => event.composedPath().find(holds)
const name = (event, files) => {
    const area = area_of(event)
    const names = [...files ?? []].map(file => file.name)
    if (area && names.length) area.setAttribute('data-reading', `Reading ${names.join(', ')} ...`)
}
const send = event => {
    const {error, pond} = event.detail, area = area_of(event), files = pond.getFiles()
    if (error) area?.removeAttribute('data-reading')
    if (!area || files.some(({status}) => status === INIT || status === LOADING)) return
    const types = files.map(({file, status}) =>
        [file._relativePath || file.name, status === LOAD_ERROR ? 'too large' : file.type])
    const {model} = Bokeh.index.query_one(view => view.el === area)
    model.mime_type = Object.fromEntries(types)
    for (const file of files) if (file.status === IDLE) pond.processFile(file)
}
document.addEventListener('drop', event => name(event, event.dataTransfer?.files), true)
document.addEventListener('input', event => name(event, event.composedPath()[0].files), true)
document.addEventListener('FilePond:addfile', send)
